// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/body/regions.h>

#include "body.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    double
    centroid_x(const Body &body, const unsigned int cell)
    {
      double x = 0.;
      for (const unsigned int node : body.fe_space.nodes(cell))
        x += 0.25 * body.mesh.get_nodes()[node][0];
      return x;
    }

    TEST(RegionShares, WithoutLengthACellBelongsToItsRegion)
    {
      const Body         body(bar_of_two_regions(1.5));
      const RegionShares shares = regions_of_materials(body.mesh, 0.);
      ASSERT_EQ(shares.n_regions(), 2u);
      EXPECT_EQ(shares.id(1), 2u);
      for (unsigned int cell = 0; cell < body.fe_space.n_cells(); ++cell)
        EXPECT_EQ(shares.share(cell, 1), centroid_x(body, cell) < 1.5 ? 0. : 1.);
    }

    TEST(RegionShares, PassIntoEachOtherLikeTheSolutionOfTheFilter)
    {
      // in a long bar: 1/2 exp(-d/l) on the far side of the border, l = length / (2 sqrt 3)
      const double       length = 1.2, l = length / std::sqrt(12.);
      const Body         body(bar_of_two_regions(2., box_mesh(4., 160, 1)));
      const RegionShares shares = regions_of_materials(body.mesh, length);
      for (unsigned int cell = 0; cell < body.fe_space.n_cells(); ++cell)
      {
        const double x = centroid_x(body, cell), far = 0.5 * std::exp(-std::abs(x - 2.) / l);
        EXPECT_NEAR(shares.share(cell, 1), x < 2. ? far : 1. - far, 0.02);
        EXPECT_NEAR(shares.share(cell, 0) + shares.share(cell, 1), 1., 1e-14);
      }
    }

    TEST(RegionShares, ASmallRegionKeepsAShareOfItself)
    {
      // a few cells of 24,000, and a length that spreads it over the whole bar
      const Body         body(bar_of_two_regions(3.9997, box_mesh(4., 4000, 1)));
      const RegionShares shares  = regions_of_materials(body.mesh, 1e3);
      double             maximum = 0.;
      for (unsigned int cell = 0; cell < body.fe_space.n_cells(); ++cell)
        maximum = std::max(maximum, shares.share(cell, 1));
      ASSERT_EQ(shares.n_regions(), 2u);
      EXPECT_GT(maximum, 0.);
      EXPECT_LT(maximum, 1e-3);
    }

    TEST(RegionShares, OneRegionIsGlobal)
    {
      const Body         body;
      const RegionShares shares = regions_of_materials(body.mesh, 1.);
      for (unsigned int cell = 0; cell < body.fe_space.n_cells(); ++cell)
        EXPECT_EQ(shares.share(cell, 0), 1.);
    }

    TEST(RegionShares, ThatArePaintedSumToOne)
    {
      // less than one, more than one, one, and as good as nothing
      const RegionShares shares = painted_regions({ { .25, 1., 1., 1e-6 }, { .5, 1., 0., 0. } });
      ASSERT_EQ(shares.n_regions(), 3u);
      const double expected[4][3]
          = { { .25, .25, .5 }, { 0., .5, .5 }, { 0., 1., 0. }, { 1., 0., 0. } };
      for (unsigned int cell = 0; cell < 4; ++cell)
        for (unsigned int region = 0; region < 3; ++region)
          EXPECT_DOUBLE_EQ(shares.share(cell, region), expected[cell][region]);
      for (unsigned int region = 0; region < 3; ++region)
        EXPECT_EQ(shares.id(region), region);
    }

    TEST(RegionShares, HaveNoRestWherePaintCoversAll)
    {
      const RegionShares shares = painted_regions({ { .5, 1. }, { .5, 0. } });
      ASSERT_EQ(shares.n_regions(), 2u);
      EXPECT_EQ(shares.id(0), 1u);
      EXPECT_THROW(painted_regions({ { 1., 1. }, { 0., 0. } }), UserError);
    }

    TEST(Material, PaintIsAFactorOfEachRegionOrStandsInstead)
    {
      MaterialParameters parameters;
      parameters.everywhere = { MaterialPreset::none, 100., .25, 10. };
      parameters.regions[2] = { MaterialPreset::none, 300., .25, 20. };
      const PaintedMaterial painted{ { { 1., 2., 3. }, true }, {}, { { 5., 6., 7. }, false } };
      const Material        material(parameters, { 1, 2, 2 }, {}, painted);
      const double          moduli[3] = { 100., 600., 900. };
      for (unsigned int cell = 0; cell < 3; ++cell)
      {
        EXPECT_DOUBLE_EQ(material.youngs_modulus(cell), moduli[cell]);
        EXPECT_DOUBLE_EQ(material.density(cell), 5. + cell);
      }
      EXPECT_THROW(Material(parameters, { 1, 2, 2 }, {}, { {}, { { 1., 2., 1. }, true }, {} }),
                   UserError);
    }
  } // namespace
} // namespace Exemplar::Testing
