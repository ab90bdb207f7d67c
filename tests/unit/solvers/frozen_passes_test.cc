// SPDX-License-Identifier: GPL-3.0-or-later
#include "body.h"
#include "scene.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace Exemplar::Testing
{
  namespace
  {
    /// The greatest distance of the states that two methods reach after so many steps.
    double
    difference(const std::string              &text,
               std::vector<std::string>        overrides,
               const std::vector<std::string> &of_one,
               const std::vector<std::string> &of_other)
    {
      std::vector<std::string> one = overrides, other = std::move(overrides);
      one.insert(one.end(), of_one.begin(), of_one.end());
      other.insert(other.end(), of_other.begin(), of_other.end());
      return max_difference(Scene(text, one).solve().positions,
                            Scene(text, other).solve().positions);
    }

    const std::vector<std::string> one_pass  = { "Solver/Method=one pass" },
                                   by_newton = { "Solver/Method=newton", "Solver/Tolerance=1e-11" };

    TEST(FrozenPasses, OneIsTheSolutionWhereTheForcesAreLinear)
    {
      // handles, prescribed weights and damping change the forces between and within steps
      const std::string weights
          = examples("set Pose functions = 1.2*x; 0.9*y; z\n"
                     " set Weights = prescribed\n set Prescribed weights = 1-t; t\n");
      EXPECT_LT(difference("set Scene = static\n" + bar + drag + weights,
                           { "Model/Strain=linear", "Time/Increments=3" }, one_pass, by_newton),
                1e-9);
      const std::string dynamic = "set Scene = dynamic\n" + bar + drag;
      EXPECT_LT(difference(dynamic,
                           { "Model/Strain=linear", "Time/Step=0.05", "Time/End=0.2",
                             "Time/Stiffness damping=0.1", "Time/Mass damping=1" },
                           one_pass, by_newton),
                1e-9);
      EXPECT_LT(difference(dynamic,
                           { "Model/Strain=linear", "Time/Step=0.05", "Time/End=0.2",
                             "Time/Stiffness damping=0.1", "Solver/Rotations=predicted" },
                           one_pass, by_newton),
                1e-9);
    }

    TEST(FrozenPasses, RepeatedTheyEndWhereNewtonDoes)
    {
      EXPECT_LT(difference("set Scene = static\n" + bar + drag, { "Time/Increments=2" },
                           { "Solver/Method=fixed point", "Solver/Tolerance=1e-11",
                             "Solver/Maximum iterations=500" },
                           by_newton),
                1e-9);
    }

    TEST(FrozenPasses, EndAtTheirLimit)
    {
      Scene       scene("set Scene = static\n" + bar + drag,
                        { "Solver/Method=fixed point", "Solver/Maximum iterations=3" });
      const State before = scene.problem.state;
      EXPECT_EQ(scene.problem.advance().status, SolveStatus::iteration_limit);
      EXPECT_TRUE(scene.problem.state == before);
    }

    TEST(FrozenPasses, AnInterpolationEndsAtRest)
    {
      // from a twist whose middle is turned by 90 degrees back to where nothing acts
      Scene scene(
          "set Scene = interpolation\n" + bar
          + examples("set Pose functions = " + twist(180.) + "\n set Prescribed weights = t; 1-t\n")
          + "subsection Time\n set Increments = 10\nend\n");
      State state = scene.solve();
      align(scene.problem.body.fe_space.rest_positions(), state.positions, Exchange::serial());
      EXPECT_LT(max_difference(state.positions, scene.problem.body.fe_space.rest_positions()),
                1e-7);
    }
  } // namespace
} // namespace Exemplar::Testing
