// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/problem/unit_review.h>

#include "scene.h"

#include <gtest/gtest.h>

#include <tuple>

namespace Exemplar::Testing
{
  namespace
  {
    std::string
    heavy_bar(const std::string &select,
              const std::string &gravity,
              const std::string &kind = "static")
    {
      return "set Scene = " + kind
             + "\nsubsection Mesh\n set Generator = box\n set Box size = 4, 1, 1\n"
               " set Box cells = 12, 3, 3\nend\n"
               "subsection Material\n set Young's modulus = 1e9\n set Poisson's ratio = 0.3\nend\n"
               "subsection Handles\n set Names = a\n subsection a\n  set Select = "
             + select + "\n end\nend\nsubsection Loads\n set Gravity = " + gravity
             + "\nend\nsubsection Time\n set Increments = 1\n set Step = 0.01\n set End = "
               "0.01\nend\n";
    }

    TEST(UnitReview, MeasuresTheBody)
    {
      const Scene        scene(heavy_bar("boundary 1", "0, 0, -10"));
      const BodyMeasures measures = measure(scene.problem.body);
      EXPECT_EQ(measures.size, (std::array<double, 3>{ { 4., 1., 1. } }));
      EXPECT_NEAR(measures.volume, 4., 1e-12);
      EXPECT_NEAR(measures.area, 18., 1e-12);
      EXPECT_NEAR(measures.mass, 4000., 1e-9);
      EXPECT_NEAR(measures.poisson.minimum, 0.3, 1e-12);
      EXPECT_DOUBLE_EQ(measures.young.maximum, 1e9);
      EXPECT_NEAR(measures.weight_over_stiffness(10.) * measures.length(), 4e-5, 1e-15);
    }

    TEST(UnitReview, EstimatesHowFarABodySags)
    {
      for (const auto &[select, gravity] :
           { std::pair<const char *, const char *>{ "boundary 1", "0, 0, -10" }, // bends
             { "boundary 1", "10, 0, 0" },                                       // hangs
             { "box -1 -1 -1 5 2 0.001", "0, 0, -10" } })                        // is pressed
      {
        Scene                scene(heavy_bar(select, gravity));
        const WeightEstimate estimate = estimate_weight(scene.problem, measure(scene.problem.body));
        const Vector         rest     = scene.problem.body.fe_space.rest_positions();
        const double         sag      = max_difference(scene.solve().positions, rest);
        EXPECT_LT(0.65 * estimate.sag, sag) << select << ", " << gravity;
        EXPECT_LT(sag, 1.5 * estimate.sag) << select << ", " << gravity;
      }
    }

    TEST(UnitReview, NothingSagsFurtherThanItFalls)
    {
      const Scene scene(heavy_bar("boundary 1", "0, 0, -1e6", "dynamic"));
      EXPECT_NEAR(estimate_weight(scene.problem, measure(scene.problem.body)).sag, 50., 1e-9);
    }

    /// A bar of jelly as heavy as lead, of which one step is made, in which nothing but masses matters.
    std::string
    dropped_bar(const double density, const std::string &mass_matrix)
    {
      return "set Scene = dynamic\nsubsection Mesh\n set Generator = box\n set Box size = 4, 1, 1\n"
             " set Box cells = 12, 3, 3\nend\n"
             "subsection Material\n set Young's modulus = 500\n set Poisson's ratio = 0.3\n"
             " set Density = "
             + std::to_string(density) + "\n set Mass matrix = " + mass_matrix
             + "\nend\nsubsection Handles\n set Names = a\n subsection a\n  set Select = boundary "
               "1\n"
               " end\nend\nsubsection Loads\n set Gravity = 0, 0, -10\nend\n"
               "subsection Time\n set Step = 1e-3\n set End = 1e-3\nend\n";
    }

    bool
    warns_of_coupled_masses(const Scene &scene)
    {
      for (const std::string &warning : unit_warnings(scene.problem))
        if (warning.find("heavier than it is stiff") != std::string::npos)
          return true;
      return false;
    }

    TEST(UnitReview, CoupledMassesThatFallFurtherThanFreelyAreNamed)
    {
      EXPECT_TRUE(warns_of_coupled_masses(Scene(dropped_bar(1e5, "consistent"))));
      EXPECT_TRUE(warns_of_coupled_masses(Scene(dropped_bar(13., "consistent"))));
      EXPECT_FALSE(
          warns_of_coupled_masses(Scene(dropped_bar(12., "consistent")))); // rho g L / E .96
      EXPECT_FALSE(warns_of_coupled_masses(Scene(dropped_bar(1e5, "lumped"))));
    }

    TEST(UnitReview, CoupledMassesFallFurtherThanFreelyBesideAHandle)
    {
      for (const auto &[mass_matrix, least, most] :
           { std::tuple<const char *, double, double>{ "consistent", 1.5, 1.6 },
             { "lumped", 0.95, 1.0001 } })
      {
        Scene          scene(dropped_bar(1e5, mass_matrix));
        const FESpace &space = scene.problem.body.fe_space;
        const Vector   rest = space.rest_positions(), end = scene.solve().positions;
        double         fallen = 0.;
        for (unsigned int dof = 2; dof < end.size(); dof += 3)
          fallen = std::max(fallen, (rest[dof] - end[dof]) / (10. * 1e-3 * 1e-3));
        EXPECT_GT(fallen, least) << mass_matrix;
        EXPECT_LT(fallen, most) << mass_matrix;
      }
    }
  } // namespace
} // namespace Exemplar::Testing
