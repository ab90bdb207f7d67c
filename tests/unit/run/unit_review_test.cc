// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/problem/unit_review.h>

#include "scene.h"

#include <gtest/gtest.h>

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
  } // namespace
} // namespace Exemplar::Testing
