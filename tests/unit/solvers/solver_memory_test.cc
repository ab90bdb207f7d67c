// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>

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

    /// Scenes with a step that is interrupted, each with a step in which much happens.
    struct HardStep
    {
      Case         scene;
      unsigned int step;        ///< which is interrupted
      unsigned int least_stops; ///< so often that step can be interrupted at least
    };

    std::vector<HardStep>
    hard_steps()
    {
      const auto obstacle = [](const std::string &shape, const std::string &keys)
      {
        return "subsection Obstacles\n set Names = it\n subsection it\n set Shape = " + shape
               + "\n set Friction = 0.4\n" + keys + " end\nend\n";
      };
      const std::string     soft = "subsection Material\n set Young's modulus = 1e5\nend\n";
      std::vector<HardStep> all;
      for (const Case &scene : cases())
        if (scene.name != "predicted_passes") // a pass is an iteration
          all.push_back({ scene, 7, 1 });
      const Case order = cases()[2];
      all.push_back({ { "fixed_point",
                        order.text,
                        { "Solver/Method=fixed point", "Solver/Rotations=predicted",
                          "Model/Gradient=frozen" } },
                      7,
                      2 });
      all.push_back({ { "fall",
                        "set Scene = dynamic\n" + bar + soft + obstacle("box 3 -2 -2 6 2 -0.52", "")
                            + "subsection Initial\n set Velocity = 0; 0; -6\nend\nsubsection "
                              "Time\n set Step = 0.02\n set End = 1\nend\n",
                        {} },
                      3,
                      8 });
      // so violent that Newton's method takes over
      all.push_back({ { "hand_over",
                        "set Scene = dynamic\n" + bar
                            + "subsection Material\n set Young's modulus = 3e3\nend\nsubsection "
                              "Initial\n set Velocity = -200*(x-2); 0; 20*x\nend\nsubsection "
                              "Time\n set Step = 0.05\n set End = 0.2\nend\n",
                        { "Solver/Method=quasi newton" } },
                      2,
                      30 });
      all.push_back({ { "stages",
                        "set Scene = static\n" + bar + soft
                            + "subsection Handles\n set Names = left\n" + held_left + "end\n"
                            + obstacle("sphere 3 0.5 1.6 0.5", "  set Motion = 0; 0; -0.9*t\n"),
                        { "Time/Increments=4" } },
                      3,
                      8 });
      all.push_back({ { "starts_from_examples",
                        cases()[0].text,
                        { "Time/Increments=4", "Solver/Starts=examples" } },
                      4,
                      2 });
      return all;
    }

    class HardStepTest : public testing::TestWithParam<HardStep>
    {
    };

    INSTANTIATE_TEST_SUITE_P(,
                             HardStepTest,
                             testing::ValuesIn(hard_steps()),
                             [](const auto &instance) { return instance.param.scene.name; });

    TEST_P(HardStepTest, MayBeAbandonedAtAnyMomentAndMadeAgain)
    {
      const auto &[scene, step, least_stops] = GetParam();
      Scene whole(scene.text, scene.overrides), stopped(scene.text, scene.overrides);
      for (unsigned int i = 1; i < step; ++i)
      {
        ASSERT_TRUE(is_success(whole.problem.advance().status));
        ASSERT_TRUE(is_success(stopped.problem.advance().status));
      }
      Problem          &problem = stopped.problem;
      const State       state   = problem.state;
      const std::string memory  = problem.solver_memory();
      unsigned int      left = 0, n_stops = 0;
      problem.solver->may_go_on = [&left] { return left-- > 0; };
      problem.solver->observe   = [&left](const SolveReport &) { return left-- > 0; };
      for (bool is_made = false; !is_made;)
      {
        left = n_stops;
        try
        {
          ASSERT_TRUE(is_success(problem.advance().status));
          is_made = true;
        }
        catch (const Interrupted &)
        {
          ++n_stops;
          ASSERT_TRUE(problem.state == state) << n_stops;
          ASSERT_EQ(problem.solver_memory(), memory) << n_stops;
        }
      }
      RecordProperty("stops", static_cast<int>(n_stops));
      EXPECT_GE(n_stops, least_stops);
      ASSERT_TRUE(is_success(whole.problem.advance().status));
      EXPECT_TRUE(problem.state == whole.problem.state);
      EXPECT_EQ(problem.solver_memory(), whole.problem.solver_memory());
      problem.solver->may_go_on = {};
      problem.solver->observe   = {};
      if (step == problem.time_axis.n_steps())
        return;
      ASSERT_TRUE(is_success(whole.problem.advance().status));
      ASSERT_TRUE(is_success(problem.advance().status));
      EXPECT_TRUE(problem.state == whole.problem.state);
    }
  } // namespace
} // namespace Exemplar::Testing
