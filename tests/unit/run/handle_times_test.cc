// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>

#include "expect_contains.h"
#include "scene.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    const std::string all_methods[] = { "newton", "quasi newton", "one pass" };

    /// A bar that is held on the left, and whose right end has a handle with these keys.
    std::string
    timed_bar(const std::string &keys, const std::string &kind = "dynamic")
    {
      return "set Scene = " + kind + "\n" + bar + "subsection Handles\n set Names = left, right\n"
             + held_left + "subsection right\n set Select = boundary 2\n"
             + "set Motion = 0.2*t; 0.6*t; 0.3*t\n" + keys + "end\nend\n"
             + "subsection Time\n set Step = 0.02\n set End = 0.4\n set Increments = 20\nend\n"
               "subsection Solver\n set Tolerance = 1e-11\nend\n";
    }

    void
    go_on(Problem &problem, const unsigned int n_steps)
    {
      for (unsigned int step = 0; step < n_steps; ++step)
        ASSERT_TRUE(is_success(problem.advance().status));
    }

    void
    expect_scene_refused(const std::string &scene, const std::string &words)
    {
      try
      {
        Scene refused(scene);
        FAIL() << words;
      }
      catch (const UserError &error)
      {
        expect_contains(error.what(), words);
      }
    }

    TEST(HandleTimes, UntilLetsGoAsACallDoes)
    {
      for (const std::string &method : all_methods)
      {
        Scene timed(timed_bar("set Until = 0.1\n"), { "Solver/Method=" + method }),
            called(timed_bar(""), { "Solver/Method=" + method });
        go_on(called.problem, 5);
        called.problem.change_handles([](Handles &handles) { handles.let_go("right"); });
        EXPECT_EQ(timed.solve().positions, called.solve().positions) << method;
      }
    }

    TEST(HandleTimes, WhatIsCaughtMovesFromWhereItIs)
    {
      for (const std::string &method : all_methods)
      {
        Scene scene(timed_bar("set Until = 0.1\n set From = 0.24\n"),
                    { "Solver/Method=" + method });
        go_on(scene.problem, 12);
        const Vector caught = scene.problem.state.positions;
        go_on(scene.problem, 8);
        const Vector &now   = scene.problem.state.positions;
        const auto   &nodes = scene.problem.constraints.handles.nodes(1);
        const double  t     = 0.4 - 0.24;
        const double  way[] = { 0.2 * t, 0.6 * t, 0.3 * t };
        ASSERT_EQ(nodes.size(), 4U);
        for (const unsigned int node : nodes)
          for (unsigned int c = 0; c < 3; ++c)
            EXPECT_NEAR(now[3 * node + c], caught[3 * node + c] + way[c], 1e-14) << method;
        EXPECT_GT(max_difference(now, Scene(timed_bar("")).solve().positions), 1e-3);
      }
    }

    TEST(HandleTimes, ResumedRunsEndInTheSameBytes)
    {
      const std::string scene = timed_bar("set Until = 0.1\n set From = 0.24\n");
      for (const std::string &method : all_methods)
      {
        const std::vector<std::string> overrides = { "Solver/Method=" + method };
        const Vector                   end       = Scene(scene, overrides).solve().positions;
        for (const unsigned int n_steps : { 3, 5, 6, 12, 13, 16 })
        {
          Scene first(scene, overrides), second(scene, overrides);
          go_on(first.problem, n_steps);
          second.problem.resume_from(first.problem.state, first.problem.solver_memory());
          EXPECT_EQ(second.solve().positions, end) << method << ", " << n_steps;
        }
      }
    }

    TEST(HandleTimes, StaticScenesLetGoAndCatch)
    {
      Scene let_go(timed_bar("set Until = 0.5\n", "static"));
      EXPECT_LT(
          max_difference(let_go.solve().positions, let_go.problem.body.fe_space.rest_positions()),
          1e-9);
      Scene caught(timed_bar("set From = 0.5\n", "static")),
          half(timed_bar("", "static"), { "Handles/right/Motion=0.1*t; 0.3*t; 0.15*t" });
      EXPECT_LT(max_difference(caught.solve().positions, half.solve().positions), 1e-9);
    }

    TEST(HandleTimes, WhatCannotBeIsRefused)
    {
      expect_scene_refused(timed_bar("set Until = 0\n"), "Until = '0' is not allowed");
      expect_scene_refused(timed_bar("set Until = 0.1\n set From = 0.1\n"), "are both 0.1");
      Scene             fixed(timed_bar(""));
      const std::string left = "Handles/left/Until=0.5";
      try
      {
        Scene(timed_bar("set Until = 0.5\n", "static"), { left });
        FAIL();
      }
      catch (const UserError &error)
      {
        expect_contains(error.what(), "6 of 6 rigid motions free");
      }
      Scene timed(timed_bar("set Until = 0.1\n"));
      EXPECT_THROW(timed.problem.change_handles([](Handles &handles) { handles.let_go("right"); }),
                   UserError);
    }

    TEST(HandleTimes, CatchesThatOverlapAreRefused)
    {
      const auto two = [](const std::string &first, const std::string &second)
      {
        return "set Scene = dynamic\n" + bar + "subsection Handles\n set Names = one, two\n"
               + "subsection one\n set Select = boundary 2\n" + first + "end\n"
               + "subsection two\n set Select = boundary 2\n" + second + "end\nend\n"
               + "subsection Time\n set Step = 0.02\n set End = 0.4\nend\n";
      };
      expect_scene_refused(two("", "set From = 0.2\n"),
                           "Let the other one go before (Handles/one/Until)");
      EXPECT_NO_THROW(Scene(two("set Until = 0.2\n", "set From = 0.2\n")));
      EXPECT_EQ(Scene(two("", "set From = 7\n")).problem.constraints.handles.get_warnings().size(),
                1U);
    }
  } // namespace
} // namespace Exemplar::Testing
