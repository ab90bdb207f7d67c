// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/mesh.h>
#include <exemplar/surface/posing/pose_carrying.h>

#include "fold_bodies.h"

#include <gtest/gtest.h>

#include <set>

namespace Exemplar::Testing
{
  namespace
  {
    /// A bar whose skin is the boundary of a finer one.
    class SkinSpringsTest : public testing::Test
    {
    protected:
      SkinSprings
      springs_to(const Points &places) const
      {
        SkinSprings springs(skin, { used.begin(), used.end() }, bar.get_nodes(), places);
        for (std::size_t k = 0; k < used.size(); ++k)
          springs.stiffness[k] = 1. + k % 3;
        return springs;
      }

      static std::set<std::size_t>
      used_by_faces(const SurfaceMesh &surface)
      {
        std::set<std::size_t> used;
        for (const auto &face : surface.faces)
          used.insert(face.begin(), face.end());
        return used;
      }

      const Mesh                  bar = small_bar(), fine = small_bar(3);
      const SurfaceMesh           surface = boundary_as_surface(fine);
      const std::set<std::size_t> used    = used_by_faces(surface);
      const SurfaceSkin           skin{ surface, bar };
      const Points                pose = bent(fine.get_nodes(), 1.);
    };

    TEST_F(SkinSpringsTest, PullByWhatTheSkinIsOffItsPlaces)
    {
      const Points x = bent(bar.get_nodes(), .7);
      Vector       displacement(3 * x.size());
      for (std::size_t i = 0; i < x.size(); ++i)
        for (unsigned int d = 0; d < 3; ++d)
          displacement[3 * i + d] = x[i][d] - bar.get_nodes()[i][d];
      const Points carried = as_points(skin.carry(displacement));
      double       mean = 0., greatest = 0., energy = 0.;
      std::size_t  k = 0;
      for (const std::size_t v : used)
      {
        const double off = carried[v].distance(pose[v]);
        mean += off / used.size();
        greatest = std::max(greatest, off);
        energy += .5 * (1. + k++ % 3) * off * off;
      }
      const SkinSprings springs = springs_to(pose);
      EXPECT_NEAR(springs.ways(x).mean, mean, 1e-12);
      EXPECT_NEAR(springs.ways(x).greatest, greatest, 1e-12);
      EXPECT_NEAR(springs.energy(x), energy, 1e-10);
      EXPECT_NEAR(springs_to(carried).energy(x), 0., 1e-20);
    }

    TEST_F(SkinSpringsTest, DerivativesAreThoseOfTheEnergy)
    {
      const SkinSprings springs = springs_to(pose);
      const Points      x       = bent(bar.get_nodes(), .7);
      const std::size_t n       = 3 * x.size();
      Vector            direction(n), product(n);
      for (std::size_t k = 0; k < n; ++k)
        direction[k] = std::sin(1. + k);
      const auto at = [&](const double step)
      {
        Points y = x;
        for (std::size_t k = 0; k < n; ++k)
          y[k / 3][k % 3] += step * direction[k];
        return y;
      };
      std::vector<double> gradient(n, 0.);
      springs.add_gradient(x, gradient);
      springs.add_product(direction, product);
      double first = 0., bound = 0.;
      for (std::size_t k = 0; k < n; ++k)
      {
        first += gradient[k] * direction[k];
        bound += springs.diagonal_bound(x.size())[k / 3] * direction[k] * direction[k];
      }
      const double second = product * direction; // the energy is quadratic
      EXPECT_NEAR((springs.energy(at(1.)) - springs.energy(at(-1.))) / 2., first,
                  1e-10 * std::abs(first));
      EXPECT_NEAR(springs.energy(at(1.)) + springs.energy(at(-1.)) - 2. * springs.energy(x), second,
                  1e-10 * second);
      EXPECT_GE(bound, second);
    }

    TEST_F(SkinSpringsTest, PosesThatFollowTheSkinAreFourTimesAsNear)
    {
      const SurfaceAttachment attachment(bar.get_nodes(), bar.get_boundary_faces(),
                                         boundary_of(fine, fine.get_nodes()));
      const Points            strong = bent(fine.get_nodes(), 2.5);
      PoseTransfer            transfer(bar.get_nodes(), bar.get_cells(), attachment, 30.);
      PoseQuality             quality;
      const double before = springs_to(strong).ways(transfer.carry(vertices(strong), quality)).mean;
      transfer.follow_skin(surface, bar);
      const Points x = transfer.carry(vertices(strong), quality);
      EXPECT_LT(springs_to(strong).ways(x).mean, .242 * before);
      EXPECT_NEAR(quality.mean_error * std::sqrt(18.), springs_to(strong).ways(x).mean,
                  .1 * before);
      EXPECT_EQ(quality.n_inverted, 0u);
      EXPECT_GT(quality.min_det, .1);
      // and a pose at rest stays what it is
      EXPECT_LT(max_distance_between(transfer.carry(surface.vertices, quality), bar.get_nodes()),
                1e-9);
    }
  } // namespace
} // namespace Exemplar::Testing
