// SPDX-License-Identifier: GPL-3.0-or-later
#include "body.h"
#include "scene.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    struct Case
    {
      std::string              name, text;
      std::vector<std::string> overrides;
    };

    /// A scene of each solver that remembers something.
    std::vector<Case>
    cases()
    {
      const std::string poses   = examples("set Pose functions = " + twist(60.) + "\n");
      const std::string dynamic = "set Scene = dynamic\n" + bar + drag + poses
                                  + "subsection Time\n set Step = 0.05\n set End = 1\n set "
                                    "Stiffness damping = 0.01\nend\n";
      return {
        { "newton",
          "set Scene = static\n" + bar + drag + poses,
          { "Solver/Method=newton", "Time/Increments=10" } },
        { "quasi_newton", dynamic, { "Solver/Method=quasi newton" } },
        { "prediction_order", dynamic, { "Solver/Prediction order=2" } },
        { "background_factor", dynamic, { "Solver/Background factor=true" } },
        // its convex tangent knows the examples and what the damping remembers
        { "quasi_newton_green", dynamic, { "Solver/Method=quasi newton", "Model/Strain=green" } },
        { "predicted_passes", dynamic, { "Solver/Method=one pass", "Solver/Rotations=predicted" } }
      };
    }

    class SolverMemoryTest : public testing::TestWithParam<Case>
    {
    protected:
      static Scene
      scene()
      {
        return Scene(GetParam().text, GetParam().overrides);
      }

      static void
      advance(Problem &problem, const unsigned int n_steps)
      {
        for (unsigned int step = 0; step < n_steps; ++step)
          ASSERT_TRUE(is_success(problem.advance().status));
      }
    };

    INSTANTIATE_TEST_SUITE_P(,
                             SolverMemoryTest,
                             testing::ValuesIn(cases()),
                             [](const auto &instance) { return instance.param.name; });

    TEST_P(SolverMemoryTest, AResumedProblemGoesOnInTheSameBytes)
    {
      Scene whole = scene(), first = scene(), second = scene();
      advance(whole.problem, 9);
      advance(first.problem, 6);
      second.problem.resume_from(first.problem.state, first.problem.solver_memory());
      advance(second.problem, 3);
      EXPECT_TRUE(second.problem.state == whole.problem.state);
      EXPECT_EQ(second.problem.solver_memory(), whole.problem.solver_memory());
      // the memory matters, else this proves nothing
      Scene without = scene();
      without.problem.resume_from(first.problem.state);
      advance(without.problem, 3);
      EXPECT_FALSE(without.problem.state == whole.problem.state);
    }

    TEST_P(SolverMemoryTest, WhatIsForgottenCountsNoMore)
    {
      Scene used = scene(), fresh = scene();
      advance(used.problem, 6);
      const State state = used.problem.state;
      used.problem.resume_from(state); // without the memory
      fresh.problem.resume_from(state);
      advance(used.problem, 2);
      advance(fresh.problem, 2);
      EXPECT_TRUE(used.problem.state == fresh.problem.state);
    }
  } // namespace
} // namespace Exemplar::Testing
