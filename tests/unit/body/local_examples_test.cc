// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/problem/problem.h>

#include "body.h"
#include "scene.h"
#include "temporary_directory.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    // Scenes with one weight vector a region.
    class LocalExamples : public InTemporaryDirectory
    {
    protected:
      /// A static scene on a bar whose halves are regions 1 and 2.
      std::string
      scene(const std::string &handles, const std::string &keys, const double border = 2.) const
      {
        write_msh(bar_of_two_regions(border), directory / "bar.msh");
        return "set Scene = static\nsubsection Mesh\n set File = "
               + (directory / "bar.msh").string() + "\nend\n" + handles
               + examples("set Pose functions = " + twist(60.) + " | 1.2*x; 0.9*y; z\n" + keys)
               + "subsection Solver\n set Tolerance = 1e-10\nend\n";
      }
    };

    TEST_F(LocalExamples, OneRegionGivesTheGlobalResultBitForBit)
    {
      for (const std::string method : { "newton", "fixed point" })
        for (const std::string keys : { "set Weights = free\n set Energy = blended\n", "" })
        {
          if (!keys.empty() && method == "newton")
            continue;
          const std::vector<std::string> overrides
              = { "Solver/Method=" + method, "Solver/Tolerance=1e-6",
                  "Solver/Maximum iterations=500" };
          const State global = Scene(scene(drag, keys, 9.), overrides).solve();
          const State local
              = Scene(scene(drag,
                            keys + "set Weights per region = true\nset Region blend length = 1\n",
                            9.),
                      overrides)
                    .solve();
          EXPECT_EQ(max_difference(global.positions, local.positions), 0.);
          EXPECT_EQ(global.weights, local.weights);
          EXPECT_EQ(global.multipliers, local.multipliers);
        }
    }

    TEST_F(LocalExamples, EachRegionFindsItsOwnExample)
    {
      // the left half is stretched and the right one twisted: no global weights fit both
      const std::string handles
          = "subsection Handles\n set Names = left, middle, right\n" + held_left
            + "subsection middle\n set Select = box 2 -1 -1 2 1 1\n set Motion = 0.4*t; -0.1*y*t; "
              "0\nend\n"
              "subsection right\n set Select = boundary 2\n"
              "set Motion = 0.4*t; -0.1*y*t-0.3*z*t; 0.3*y*t\nend\nend\n";
      const State state = Scene(scene(handles, "set Weights per region = true\n")).solve();
      ASSERT_EQ(state.weights.size(), 6u);
      for (const unsigned int region : { 0, 1 })
      {
        double sum = 0.;
        for (unsigned int i = 0; i < 3; ++i)
        {
          EXPECT_GE(state.weights[3 * region + i], 0.);
          sum += state.weights[3 * region + i];
        }
        EXPECT_NEAR(sum, 1., 1e-14);
      }
      EXPECT_GT(state.weights[2], 0.5); // left: stretched
      EXPECT_LT(state.weights[1], 0.2);
      EXPECT_GT(state.weights[4], state.weights[1] + 0.1); // right: twisted
    }

    TEST_F(LocalExamples, TheRidgeIsSharedByVolume)
    {
      // a region is a quarter of the bar, so that equal weights in both cost what one weight for all does
      const std::string ridge   = "set Energy = scaled\n set Weight penalty = 0.01\n";
      const auto        penalty = [&](const std::string &keys)
      { return Scene(scene(drag, ridge + keys, 1.)).problem.examples.weights.penalty_matrix(); };
      const dealii::FullMatrix<double> global = penalty(""),
                                       local  = penalty("set Weights per region = true\n");
      ASSERT_EQ(local.m(), 6u);
      EXPECT_GT(global(1, 1), 0.);
      EXPECT_NEAR(local(1, 1), 0.25 * global(1, 1), 1e-12 * global(1, 1));
      EXPECT_NEAR(local(4, 4), 0.75 * global(1, 1), 1e-12 * global(1, 1));
    }

    TEST_F(LocalExamples, ABlendLengthJoinsTheRegions)
    {
      const auto difference = [&](const std::string &length)
      {
        const State state
            = Scene(scene(drag, "set Weights = free\n set Weights per region = true\n"
                                "set Weight penalty = paper\n set Region blend length = "
                                    + length + "\n"),
                    { "Solver/Method=fixed point", "Solver/Maximum iterations=500" })
                  .solve();
        return std::abs(state.weights[1] - state.weights[4]);
      };
      // where the regions share all cells the weights tend to be the same
      EXPECT_GT(difference("0"), 0.1);
      EXPECT_LT(difference("100"), 0.02 * difference("0"));
    }

    TEST_F(LocalExamples, PrescribedWeightsARegion)
    {
      const std::string keys = "set Importance = 1\nset Weights = prescribed\n"
                               "set Weights per region = true\n";
      Scene             same(scene(drag, keys + "set Prescribed weights = 1-t; t; 0\n"));
      EXPECT_EQ(same.problem.examples.weights.at(0.25),
                (std::vector<double>{ 0.75, 0.25, 0., 0.75, 0.25, 0. }));
      Scene each(scene(drag, keys + "set Prescribed weights = 1-t; t; 0 | 1; 0; 0\n"));
      EXPECT_EQ(each.problem.examples.weights.at(0.25),
                (std::vector<double>{ 0.75, 0.25, 0., 1., 0., 0. }));
      EXPECT_THROW(
          Scene(scene(drag, keys + "set Prescribed weights = 1; 0; 0 | 1; 0; 0 | 1; 0; 0\n")),
          UserError);
    }

    TEST_F(LocalExamples, UmfpackAgrees)
    {
      const std::string text
          = scene(drag, "set Weights = free\n set Weights per region = true\n"
                        "set Region blend length = 1\n set Weight penalty = paper\n");
      const std::vector<std::string> fixed_point
          = { "Solver/Method=fixed point", "Solver/Maximum iterations=500",
              "Solver/Tolerance=1e-10" };
      auto with_umfpack = fixed_point;
      with_umfpack.push_back("Solver/Linear solver=umfpack");
      const State a = Scene(text, fixed_point).solve(), b = Scene(text, with_umfpack).solve();
      EXPECT_LT(max_difference(a.positions, b.positions), 1e-9);
      for (unsigned int i = 0; i < a.weights.size(); ++i)
        EXPECT_NEAR(a.weights[i], b.weights[i], 1e-8);
    }
  } // namespace
} // namespace Exemplar::Testing
