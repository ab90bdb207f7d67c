// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/surface/shape/vectors.h>
#include <exemplar/surface/skin/surface_anchors.h>
#include <exemplar/surface/skin/surface_skin.h>

#include "expect_contains.h"
#include "fold_bodies.h"

#include <gtest/gtest.h>

#include <map>

namespace Exemplar::Testing
{
  namespace
  {
    using Map = std::function<dealii::Point<3>(const dealii::Point<3> &)>;

    Vector
    displacement_by(const Mesh &mesh, const Map &map)
    {
      Vector u(3 * mesh.n_nodes());
      for (unsigned int node = 0; node < mesh.n_nodes(); ++node)
        for (unsigned int c = 0; c < 3; ++c)
          u[3 * node + c] = map(mesh.get_nodes()[node])[c] - mesh.get_nodes()[node][c];
      return u;
    }

    /// Inside the bar, on its boundary, at its nodes and up to `outside` beyond.
    SurfaceMesh
    points_around(const Mesh &bar, const double outside)
    {
      SurfaceMesh                            surface;
      std::mt19937                           generator(7);
      std::uniform_real_distribution<double> share(0., 1.);
      for (int i = 0; i < 300; ++i)
      {
        SpaceVector x{ { 4. * share(generator), share(generator) - .5, share(generator) - .5 } };
        if (i >= 100) // onto a side, and beyond
          x[1 + i % 2] = (i % 4 < 2 ? 1. : -1.) * (.5 + (i < 200 ? 0. : outside));
        surface.vertices.push_back(x);
      }
      for (const auto &node : vertices(bar.get_nodes()))
        surface.vertices.push_back(node);
      return surface;
    }

    double
    max_error(const Mesh &bar, const SurfaceMesh &surface, const Map &map)
    {
      const auto carried = SurfaceSkin(surface, bar, "skin").carry(displacement_by(bar, map));
      double     error   = 0.;
      for (std::size_t v = 0; v < carried.size(); ++v)
      {
        const auto &X = surface.vertices[v];
        const auto  x = map({ X[0], X[1], X[2] });
        error = std::max(error, x.distance({ carried[v][0], carried[v][1], carried[v][2] }));
      }
      return error;
    }

    dealii::Point<3>
    quadratic(const dealii::Point<3> &x)
    {
      return { x[0] + .2 * x[0] * x[0] - .3 * x[1] * x[2] + 2., x[1] - .4 * x[0] * x[1],
               .7 * x[2] + .1 * x[2] * x[2] + .3 * x[0] * x[2] - .2 * x[1] * x[1] };
    }

    dealii::Point<3>
    linear(const dealii::Point<3> &x)
    {
      return { 2. * x[0] - x[1] + 3., .5 * x[1] + x[2], x[2] - 4. * x[0] };
    }

    TEST(SurfaceSkin, CarriesQuadraticMotionsExactlyInsideOnTheBoundaryAndOutside)
    {
      for (const unsigned int n_across : { 2u, 3u })
      {
        const Mesh bar = small_bar(n_across);
        EXPECT_LT(max_error(bar, points_around(bar, .1), quadratic), 1e-8);
      }
    }

    TEST(SurfaceSkin, CarriesLinearMotionsExactlyByMeshesThatDoNotTellSquares)
    {
      const Mesh bar = small_bar(1);
      EXPECT_LT(max_error(bar, points_around(bar, .3), linear), 1e-8);
      const Mesh  one(make_msh({ { 0., 0., 0. }, { 1., 0., 0. }, { 0., 1., 0. }, { 0., 0., 1. } },
                               { { { 0, 1, 2, 3 } } }),
                      "one");
      SurfaceMesh surface;
      surface.vertices = { { { .1, .1, .1 } }, { { 1., 0., 0. } }, { { -.1, .3, .3 } } };
      EXPECT_LT(max_error(one, surface, linear), 1e-12);
    }

    TEST(SurfaceSkin, AThinPlateCarriesAsAThickOne)
    {
      MeshParameters parameters;
      parameters.generator = MeshGenerator::box;
      parameters.box_size  = { { 4., 1., 1e-5 } };
      parameters.box_cells = { { 8, 3, 3 } };
      const Mesh  plate(parameters);
      SurfaceMesh surface = points_around(plate, .1);
      for (auto &vertex : surface.vertices)
        vertex[2] *= 1e-5;
      EXPECT_LT(max_error(plate, surface, linear), 1e-8);
    }

    TEST(SurfaceSkin, AtRestVerticesStayToTheLastBitInTheUnitOfTheFile)
    {
      const Mesh     bar = small_bar(2);
      MeshParameters parameters;
      parameters.generator = MeshGenerator::box;
      parameters.box_size  = { { 4., 1., 1. } };
      parameters.box_cells = { { 8, 2, 2 } };
      parameters.scale     = 1e-3 / 3.;
      const Mesh        small(parameters);
      const SurfaceMesh surface = points_around(bar, .05);
      const SurfaceSkin skin(surface, small, "skin");
      Vector            u(3 * small.n_nodes());
      EXPECT_EQ(skin.carry(u), surface.vertices);
      u = parameters.scale; // one unit of the file along each axis
      for (std::size_t v = 0; v < surface.vertices.size(); ++v)
        for (unsigned int c = 0; c < 3; ++c)
          EXPECT_NEAR(skin.carry(u)[v][c], surface.vertices[v][c] + 1., 1e-12);
    }

    TEST(SurfaceSkin, InvertedAndFlatCellsGiveNumbers)
    {
      const Mesh bar  = small_bar(2);
      const auto skin = SurfaceSkin(points_around(bar, .1), bar, "skin");
      const Map  flat = [](const dealii::Point<3> &x) { return dealii::Point<3>(x[0], 0., 0.); };
      const Map  inside_out
          = [](const dealii::Point<3> &x) { return dealii::Point<3>(x[0], x[1], -x[2]); };
      for (const Map &map : { flat, inside_out })
        for (const auto &x : skin.carry(displacement_by(bar, map)))
          EXPECT_TRUE(std::isfinite(x[0] + x[1] + x[2]));
    }

    /// The greatest and the mean angle between normals on both sides of the edges of boundary
    /// faces that lie in one plane at rest.
    class NormalJumps
    {
    public:
      explicit NormalJumps(const Mesh &bar)
      {
        std::map<std::pair<unsigned int, unsigned int>,
                 std::vector<std::pair<unsigned int, unsigned int>>>
                    opposite; // of edges: the node and the face
        const auto &faces = bar.get_boundary_faces();
        for (unsigned int f = 0; f < faces.size(); ++f)
          for (int a = 0; a < 3; ++a)
          {
            const auto edge = std::minmax(faces[f].nodes[a], faces[f].nodes[(a + 1) % 3]);
            opposite[edge].push_back({ faces[f].nodes[(a + 2) % 3], f });
          }
        const auto &X = bar.get_nodes();
        for (const auto &[edge, sides] : opposite)
        {
          if (faces[sides[0].second].boundary_id != faces[sides[1].second].boundary_id)
            continue;
          const dealii::Point<3> p = X[edge.first] + .4 * (X[edge.second] - X[edge.first]);
          for (const auto &x :
               { p, p + 1e-5 * (X[edge.second] - p), p + 1e-5 * (X[sides[0].first] - p),
                 p + 1e-5 * (X[sides[1].first] - p) })
          {
            points.vertices.push_back({ { x[0], x[1], x[2] } });
            barycentric.push_back(barycentric_in(bar, faces, sides, points.vertices.size() % 4, x));
          }
        }
      }

      const SurfaceMesh &
      get_points() const
      {
        return points;
      }

      /// Carried by N_a x_a.
      std::vector<SurfaceMesh::Vertex>
      carry_barycentrically(const Vector &u) const
      {
        auto places = points.vertices;
        for (std::size_t v = 0; v < places.size(); ++v)
          for (int a = 0; a < 3; ++a)
            for (unsigned int c = 0; c < 3; ++c)
              places[v][c] += barycentric[v].second[a] * u[3 * barycentric[v].first[a] + c];
        return places;
      }

      static std::pair<double, double>
      measure(const std::vector<SurfaceMesh::Vertex> &x)
      {
        double maximum = 0., sum = 0.;
        for (std::size_t v = 0; v < x.size(); v += 4)
        {
          const SpaceVector along = minus(x[v + 1], x[v]);
          const SpaceVector n     = cross(along, minus(x[v + 2], x[v])),
                            m     = cross(minus(x[v + 3], x[v]), along);
          const double angle      = std::atan2(norm(cross(n, m)), dot(n, m));
          maximum                 = std::max(maximum, angle);
          sum += angle;
        }
        return { maximum * 180. / M_PI, 4. * sum / x.size() * 180. / M_PI };
      }

    private:
      using Barycentric = std::pair<std::array<unsigned int, 3>, SpaceVector>;

      /// In the face to which the k-th of four points (counted from 1; 0 is the fourth) belongs.
      static Barycentric
      barycentric_in(const Mesh                                               &bar,
                     const std::vector<BoundaryFace>                          &faces,
                     const std::vector<std::pair<unsigned int, unsigned int>> &sides,
                     const std::size_t                                         k,
                     const dealii::Point<3>                                   &x)
      {
        const auto &nodes = faces[sides[k == 0 ? 1 : 0].second].nodes;
        const auto &X     = bar.get_nodes();
        SpaceVector shares;
        const auto  normal
            = dealii::cross_product_3d(X[nodes[1]] - X[nodes[0]], X[nodes[2]] - X[nodes[0]]);
        for (int a = 0; a < 3; ++a)
          shares[a] = dealii::cross_product_3d(X[nodes[(a + 1) % 3]] - x, X[nodes[(a + 2) % 3]] - x)
                      * normal / normal.norm_square();
        return { nodes, shares };
      }

      SurfaceMesh              points;
      std::vector<Barycentric> barycentric;
    };

    TEST(SurfaceSkin, NormalsJumpLessThanAFifthOfBarycentricOnes)
    {
      for (const unsigned int n_across : { 2u, 3u, 4u })
      {
        const Mesh        bar = small_bar(n_across);
        const NormalJumps jumps(bar);
        const Vector      u     = displacement_by(bar,
                                                  [](const dealii::Point<3> &x)
                                                  {
                                           const double a = .5 * M_PI * x[0] / 4.;
                                           return dealii::Point<3>(
                                               x[0], x[1] * std::cos(a) - x[2] * std::sin(a),
                                               x[1] * std::sin(a) + x[2] * std::cos(a));
                                         });
        const auto        plain = NormalJumps::measure(jumps.carry_barycentrically(u));
        const auto        smooth
            = NormalJumps::measure(SurfaceSkin(jumps.get_points(), bar, "skin").carry(u));
        std::cout << "bar of " << n_across
                  << " cells across, twisted by 90 degrees: normals jump by at most " << plain.first
                  << " (mean " << plain.second << ") degrees, carried smoothly by " << smooth.first
                  << " (" << smooth.second << ")\n";
        EXPECT_LT(smooth.first, plain.first / 5.);
        EXPECT_LT(smooth.second, plain.second / 5.);
      }
    }
    TEST(SurfaceSkin, ASurfaceThatIsNotOfTheBodyIsRefused)
    {
      const Mesh bar       = small_bar(2);
      const auto complaint = [&](const SpaceVector &shift, const double factor)
      {
        SurfaceMesh surface = boundary_as_surface(bar);
        for (auto &x : surface.vertices)
          x = plus(shift, factor, x);
        try
        {
          const SurfaceSkin skin(surface, bar, "cat.obj");
        }
        catch (const UserError &error)
        {
          return std::string(error.what());
        }
        return std::string();
      };
      EXPECT_EQ(complaint({ { 0., .05, 0. } }, 1.), "");
      for (const char *part : { "Mesh/Surface: cat.obj is not the surface of box: its vertex ",
                                "The surface is 1000 times as large", "Mesh/Scale" })
        expect_contains(complaint({ { 0., 0., 0. } }, 1000.), part);
      for (const char *part :
           { "the boundary of the body is ", "The surface is 0.001 times as large" })
        expect_contains(complaint({ { 2., 0., 0. } }, .001), part);
      for (const char *part :
           { "is farthest outside the body, by 23.6 %", "(1 in the unit of the files)" })
        expect_contains(complaint({ { 1., 0., 0. } }, 1.), part);
    }
  } // namespace
} // namespace Exemplar::Testing
