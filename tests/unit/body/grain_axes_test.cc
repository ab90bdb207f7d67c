// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/body/grain_axes.h>

#include "body.h"

#include <gtest/gtest.h>

#include <cmath>

namespace Exemplar::Testing
{
  namespace
  {
    MaterialParameters
    fibres(const std::string &direction)
    {
      MaterialParameters parameters;
      parameters.everywhere.own["Fibre stiffness"] = 1.;
      parameters.everywhere.fibre_direction        = direction;
      return parameters;
    }

    std::string
    message_of(const std::string &direction)
    {
      const Mesh mesh(box_mesh(4., 4, 2));
      try
      {
        grain_axes_of(fibres(direction), mesh);
      }
      catch (const UserError &error)
      {
        return error.what();
      }
      return "";
    }

    void
    expect_in(const std::string &part, const std::string &text)
    {
      EXPECT_NE(text.find(part), std::string::npos) << text;
    }

    // On a straight bar the harmonic function is linear, which linear elements have.
    TEST(GrainAxes, BetweenTheEndsOfAStraightBarFibresGoStraight)
    {
      const Mesh mesh(box_mesh(4., 4, 2));
      for (const GrainAxes &axes : grain_axes_of(fibres("from boundary 1 to boundary 2"), mesh))
      {
        EXPECT_NEAR(axes.along[0], 1., 1e-12);
        EXPECT_NEAR(axes.along[1], 0., 1e-12);
        EXPECT_NEAR(axes.along[2], 0., 1e-12);
      }
    }

    // Of a ring the harmonic function between two radial cuts is the angle.
    TEST(GrainAxes, InABentBarFibresFollowTheArc)
    {
      MshFile contents = Mesh(box_mesh(4., 24, 6)).get_contents();
      for (dealii::Point<3> &x : contents.nodes)
      {
        const double angle = M_PI / 8. * x[0], r = 2. + x[2];
        x = dealii::Point<3>(r * std::sin(angle), x[1], r * std::cos(angle));
      }
      const Mesh mesh(contents, "arc");
      double     maximum = 0.;
      const auto all
          = grain_axes_of(fibres("from box -0.01 -1 0 0.01 1 9 to box 0 -1 -0.01 9 1 0.01"), mesh);
      for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
      {
        dealii::Point<3> x;
        for (const unsigned int node : mesh.get_cells()[cell])
          x += 0.25 * mesh.get_nodes()[node];
        const double r = std::hypot(x[0], x[2]);
        const auto  &a = all[cell].along;
        maximum        = std::max(maximum, 1. - (a[0] * x[2] - a[2] * x[0]) / r);
      }
      EXPECT_LT(std::acos(1. - maximum), 0.08); // cells are a sixth of the thickness large
    }

    // Beyond the box, along x, the function is linear; in the box it is constant.
    TEST(GrainAxes, WhereNoWayLeadsFibresGoOnAsThoseOfTheNeighbours)
    {
      const Mesh               mesh(box_mesh(8., 16, 2));
      std::vector<std::string> warnings;
      for (const GrainAxes &axes : find_grain_axes(
               fibres("from box -1 -2 -2 4.2 2 2 to boundary 2"), mesh, {}, {}, warnings))
        EXPECT_NEAR(axes.along[0], 1., 1e-9);
      ASSERT_EQ(warnings.size(), 1u);
      expect_in("192 of 384 cells no way leads from 'box", warnings[0]);
    }

    TEST(GrainAxes, AFewCellsWithoutAWayAreNotWorthAWarning)
    {
      const Mesh               mesh(box_mesh(8., 16, 2));
      std::vector<std::string> warnings;
      find_grain_axes(fibres("from boundary 1 to boundary 2"), mesh, {}, {}, warnings);
      EXPECT_TRUE(warnings.empty());
    }

    TEST(GrainAxes, FormulasAreNormalisedAndRegionsHaveTheirOwn)
    {
      const Mesh         mesh(bar_of_two_regions(2.), "test");
      MaterialParameters parameters         = fibres("0; 3; 4");
      parameters.regions[2]                 = parameters.everywhere;
      parameters.regions[2].fibre_direction = "x; 0; 0";
      const auto axes                       = grain_axes_of(parameters, mesh);
      for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
        if (mesh.get_material_ids()[cell] == 2)
          EXPECT_NEAR(axes[cell].along[0], 1., 1e-15);
        else
          EXPECT_NEAR(axes[cell].along[2], 0.8, 1e-15);
    }

    TEST(GrainAxes, DirectionsThatAreNoneAreRefusedInWords)
    {
      expect_in("is 0 in", message_of("0; 0; 0"));
      expect_in("share", message_of("from boundary 1 to boundary 1"));
      expect_in("from boundary 1 to boundary 2", message_of("from boundary 1"));
      expect_in("Material/Fibre direction = 'bok 1'", message_of("from bok 1 to boundary 2"));
    }

    TEST(GrainAxes, WithoutGrainThereAreNone)
    {
      const Mesh mesh(box_mesh(4., 4, 1));
      EXPECT_TRUE(grain_axes_of(MaterialParameters(), mesh).empty());
    }

    TEST(Orthotropy, OfIsotropicConstantsIsTheIsotropicMaterial)
    {
      const CellMaterial<double> material{ 1.2, 0.8 };
      const double               E = 0.8 * (3. * 1.2 + 1.6) / 2., nu = 1.2 / 4.;
      const auto grain = orthotropy_of({ { E, E, E, nu, nu, nu, 0.8, 0.8, 0.8 } }, 0., "key");
      EXPECT_NEAR(grain.isotropic_part().lambda, material.lambda, 1e-14);
      EXPECT_NEAR(grain.isotropic_part().mu, material.mu, 1e-14);
      EXPECT_NEAR(grain.lambda_of_patches(), material.lambda, 1e-14);
      EXPECT_NEAR(grain.least(), material.mu, 1e-14);
      EXPECT_EQ(Orthotropy(material, 0.).norm_of_grain(), 0.);
    }

    TEST(Orthotropy, WhatPatchesLeaveIsPositiveDefinite)
    {
      for (const double fibre : { 0., 1., 100. })
      {
        const auto grain
            = orthotropy_of({ { 3., 1., 0.5, 0.3, 0.4, 0.35, 0.2, 0.3, 0.4 } }, fibre, "key");
        EXPECT_GT(grain.without(grain.lambda_of_patches()).least(), 0.);
        const Orthotropy<double> fibrous(CellMaterial<double>{ 1e3, 1. }, fibre);
        EXPECT_GT(fibrous.without(fibrous.lambda_of_patches()).least(), 0.);
      }
      EXPECT_THROW(orthotropy_of({ { 1., 1., 1., 0.6, 0.6, 0.6, 1., 1., 1. } }, 0., "key"),
                   UserError);
      EXPECT_THROW(orthotropy_of({ { -1., 1., 1., 0., 0., 0., 1., 1., 1. } }, 0., "key"),
                   UserError);
    }

    // In turned axes, a tension along the first one has the strains that the nine constants say.
    TEST(Orthotropy, ATensionHasTheStrainsOfTheConstants)
    {
      const auto grain
          = orthotropy_of({ { 3., 1., 0.5, 0.3, 0.4, 0.35, 0.2, 0.3, 0.4 } }, 0., "key");
      const GrainAxes axes{ { { 0.6, 0., 0.8 } }, { { 0., 1., 0. } } };
      const auto      entries = grain.entries(axes);
      const auto      C       = Anisotropic<double>::from_numbers([&](const std::size_t k)
                                                       { return k < 3 ? 1. : entries[k - 3]; });
      const auto      dyad    = [](const std::array<double, 3> &a)
      {
        Matrix3<double> M;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            M[i][j] = a[i] * a[j];
        return M;
      };
      const Matrix3<double> a = dyad(axes.along), b = dyad(axes.across),
                            c      = dyad({ { -0.8, 0., 0.6 } });
      const Matrix3<double> strain = combine(1. / 3., a, 1., combine(-0.35 / 3., b, -0.4 / 3., c));
      const Matrix3<double> T      = stress(C, strain);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          EXPECT_NEAR(T[i][j], a[i][j], 1e-14);
    }
  } // namespace
} // namespace Exemplar::Testing
