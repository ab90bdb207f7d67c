// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>

#include "expect_contains.h"
#include "scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

namespace Exemplar::Testing
{
  namespace
  {
    const std::string twisted_bar = "set Scene = dynamic\n" + bar + drag
                                    + examples("set Pose functions = x; y+0.1*x*z; z-0.1*x*y\n")
                                    + "subsection Time\n set Step = 0.1\n set End = 1\nend\n";

    const std::string static_bar
        = "set Scene = static\n" + bar + drag + "subsection Time\n set Increments = 4\nend\n";

    void
    expect_same_bytes(const State &a, const State &b)
    {
      EXPECT_EQ(a.positions, b.positions);
      EXPECT_EQ(a.velocities, b.velocities);
      EXPECT_EQ(a.weights, b.weights);
    }

    TEST(Problem, TwoInTwoThreadsGiveTheBytesOfOneAfterTheOther)
    {
      const State dynamic = Scene(twisted_bar).solve(), statics = Scene(static_bar).solve();
      for (unsigned int repetition = 0; repetition < 5; ++repetition)
      {
        State       dynamic_beside, statics_beside;
        std::thread first([&] { dynamic_beside = Scene(twisted_bar).solve(); });
        std::thread second([&] { statics_beside = Scene(static_bar).solve(); });
        first.join();
        second.join();
        expect_same_bytes(dynamic, dynamic_beside);
        expect_same_bytes(statics, statics_beside);
      }
    }

    TEST(Problem, AMotionThatIsSetStandsForTheFormula)
    {
      const State by_formula = Scene(static_bar).solve();
      Scene       by_function("set Scene = static\n" + bar
                              + "subsection Handles\n set Names = left, right\n" + held_left
                              + "subsection right\n set Select = boundary 2\nend\nend\n"
                              + "subsection Time\n set Increments = 4\nend\n");
      by_function.problem.set_motion(
          "right",
          [](const std::vector<dealii::Point<3>> &rest, const double t)
          {
            const dealii::Tensor<1, 3> way({ 0.2 * t, 0.6 * t, 0.3 * t });
            return std::vector<dealii::Tensor<1, 3>>(rest.size(), way);
          });
      EXPECT_LT(max_difference(by_function.solve().positions, by_formula.positions), 1e-12);
    }

    std::string
    message_of(const std::function<void()> &function)
    {
      try
      {
        function();
      }
      catch (const std::exception &error)
      {
        return error.what();
      }
      return "no exception";
    }

    const std::string swung_bar = "set Scene = dynamic\n" + bar + drag
                                  + "subsection Time\n set Step = 0.02\n set End = 1\nend\n"
                                    "subsection Solver\n set Tolerance = 1e-11\nend\n";

    /// The same bar, of which only the left end is held.
    const std::string hanging_bar = "set Scene = dynamic\n" + bar
                                    + "subsection Handles\n set Names = left\n" + held_left
                                    + "end\nsubsection Time\n set Step = 0.02\n set End = 1\nend\n"
                                      "subsection Solver\n set Tolerance = 1e-11\nend\n";

    void
    advance(Problem &problem, const unsigned int n_steps)
    {
      for (unsigned int step = 0; step < n_steps; ++step)
        ASSERT_TRUE(is_success(problem.advance().status));
    }

    std::vector<unsigned int>
    nodes_beyond(const Problem &problem, const double x)
    {
      std::vector<unsigned int> nodes;
      for (unsigned int node = 0; node < problem.body.mesh.n_nodes(); ++node)
        if (problem.body.mesh.get_nodes()[node][0] > x)
          nodes.push_back(node);
      return nodes;
    }

    TEST(Problem, WhatIsLetGoMovesAsIfItHadNeverBeenHeld)
    {
      for (const std::string method : { "newton", "quasi newton", "one pass" })
      {
        Scene scene(swung_bar, { "Solver/Method=" + method }),
            free(hanging_bar, { "Solver/Method=" + method });
        advance(scene.problem, 5);
        scene.problem.change_handles([](Handles &handles) { handles.let_go("right"); });
        free.problem.resume_from(scene.problem.state);
        advance(scene.problem, 5);
        advance(free.problem, 5);
        EXPECT_LT(max_difference(scene.problem.state.positions, free.problem.state.positions), 1e-8)
            << method;
        EXPECT_EQ(scene.problem.constraints.free_dofs.list(),
                  free.problem.constraints.free_dofs.list());
        EXPECT_EQ(scene.problem.constraints.handles.sum_over(1, scene.problem.evaluation.gradient),
                  (dealii::Tensor<1, 3>()));
      }
    }

    TEST(Problem, WhatIsGrabbedMovesAsIfItHadAlwaysBeenAHandle)
    {
      for (const std::string method : { "newton", "quasi newton", "one pass" })
      {
        Scene scene(hanging_bar, { "Solver/Method=" + method }),
            held(swung_bar, { "Solver/Method=" + method });
        advance(scene.problem, 5);
        const auto way = [](const std::vector<dealii::Point<3>> &rest, const double t)
        {
          return std::vector<dealii::Tensor<1, 3>>(
              rest.size(), dealii::Tensor<1, 3>({ 0.2 * t, 0.6 * t, 0.3 * t }));
        };
        const auto nodes = nodes_beyond(scene.problem, 3.9);
        scene.problem.change_handles([&](Handles &handles) { handles.grab("hand", nodes, way); });
        held.problem.resume_from(scene.problem.state);
        advance(scene.problem, 5);
        advance(held.problem, 5);
        EXPECT_LT(max_difference(scene.problem.state.positions, held.problem.state.positions), 1e-8)
            << method;
      }
    }

    TEST(Problem, ChangesThatLeaveABodyFreeOrHeldAltogetherAreRefused)
    {
      Scene      scene(static_bar), same(static_bar);
      const auto let_go = [](Handles &handles) { handles.let_go("left"), handles.let_go("right"); };
      const auto stay   = [](const std::vector<dealii::Point<3>> &rest, double)
      { return std::vector<dealii::Tensor<1, 3>>(rest.size()); };
      const auto grab_all
          = [&](Handles &handles) { handles.grab("all", nodes_beyond(scene.problem, -1.), stay); };
      const auto grab_without_motion
          = [&](Handles &handles) { handles.grab("hand", nodes_beyond(scene.problem, 3.9), {}); };
      const auto let_go_another = [](Handles &handles) { handles.let_go("middle"); };
      advance(scene.problem, 1);
      advance(same.problem, 1);
      expect_contains(message_of([&] { scene.problem.change_handles(let_go); }),
                      "6 of 6 rigid motions free");
      expect_contains(message_of([&] { scene.problem.change_handles(grab_all); }),
                      "nothing to solve");
      expect_contains(message_of([&] { scene.problem.change_handles(grab_without_motion); }),
                      "Handle 'hand' has no motion.");
      expect_contains(message_of([&] { scene.problem.change_handles(let_go_another); }),
                      "There is no handle 'middle'. Handles/Names has: left, right.");
      advance(scene.problem, 1);
      advance(same.problem, 1);
      expect_same_bytes(scene.problem.state, same.problem.state);
    }

    /// A bar with an example, gravity and both dampings.
    std::string
    changeable_bar(const std::string &material,
                   const std::string &importance,
                   const std::string &gravity,
                   const std::string &damping)
    {
      return "set Scene = dynamic\n" + bar + drag + "subsection Material\n" + material + "end\n"
             + examples("set Pose functions = x; y+0.1*x*z; z-0.1*x*y\nset Importance = "
                        + importance + "\n")
             + "subsection Loads\n set Gravity = 0, 0, " + gravity + "\nend\n"
             + "subsection Time\n set Step = 0.02\n set End = 1\n set Stiffness damping = "
             + damping + "\nend\nsubsection Solver\n set Tolerance = 1e-11\nend\n";
    }

    TEST(Problem, WhatIsChangedBetweenStepsActsAsIfItHadBeenSoAtFirst)
    {
      const std::string soft
          = "set Young's modulus = 1e5\n",
          stiff = "set Young's modulus = 4e5\nset Poisson's ratio = 0.3\nset Density = 700\n";
      for (const std::string method : { "newton", "quasi newton" })
        for (const std::string dilatation : { "cells", "patches" })
        {
          std::vector<std::string> keys
              = { "Solver/Method=" + method, "Model/Dilatation=" + dilatation };
          if (dilatation == "patches")
            keys.insert(keys.end(), { "Examples/Energy=blended", "Examples/Example modulus=2e5" });
          Scene changed(changeable_bar(soft, "0.8", "-1", "0"), keys),
              other(changeable_bar(stiff, "0.4", "-9", "0.01"), keys);
          advance(changed.problem, 3);
          changed.problem.set_material({ { 4e5 }, { 0.3 }, { 700. } });
          changed.problem.set_importance(0.4);
          changed.problem.set_gravity({ { 0., 0., -9. } });
          changed.problem.set_damping(0., 0.01);
          other.problem.resume_from(changed.problem.state);
          const Evaluation &now = changed.problem.evaluation, &then = other.problem.evaluation;
          EXPECT_NEAR(now.potential, then.potential, 1e-10 * std::abs(then.potential));
          EXPECT_LT(max_difference(now.gradient, then.gradient),
                    1e-10 * then.gradient.linfty_norm());
          advance(changed.problem, 3);
          advance(other.problem, 3);
          EXPECT_LT(max_difference(changed.problem.state.positions, other.problem.state.positions),
                    1e-8)
              << method << ", " << dilatation;
          EXPECT_NEAR(changed.problem.state.weights[1], other.problem.state.weights[1], 1e-7);
        }
    }

    TEST(Problem, LoadsMayComeLater)
    {
      Scene scene(static_bar),
          loaded(static_bar + "subsection Loads\n set Gravity = 0, 0, -1\nend\n");
      scene.problem.set_gravity({ { 0., 0., -1. } });
      EXPECT_EQ(scene.problem.evaluation.gradient, loaded.problem.evaluation.gradient);
      Vector forces(scene.problem.body.fe_space.n_dofs());
      forces              = 2.;
      const double before = scene.problem.evaluation.gradient[0];
      scene.problem.set_nodal_forces(forces);
      EXPECT_NEAR(scene.problem.evaluation.gradient[0], before - 2., 1e-12);
      scene.problem.set_nodal_forces({});
      advance(scene.problem, 2);
      advance(loaded.problem, 2);
      expect_same_bytes(scene.problem.state, loaded.problem.state);
    }

    TEST(Problem, StepsHaveAnyLength)
    {
      Scene          scene(swung_bar), same(swung_bar);
      Problem       &problem = scene.problem;
      const TimeAxis axis    = problem.time_axis;
      const double   h       = axis.step_size(1);
      ASSERT_TRUE(is_success(problem.advance(step_of(problem, h)).status));
      advance(same.problem, 1);
      expect_same_bytes(problem.state, same.problem.state);
      ASSERT_TRUE(is_success(problem.advance(step_of(problem, 0.3 * h)).status));
      EXPECT_NEAR(problem.state.time, 1.3 * h, 1e-14);
      EXPECT_EQ(step_towards(problem, 1.5 * h).end, 1.5 * h);
      ASSERT_TRUE(is_success(problem.advance().status));
      EXPECT_NEAR(problem.state.time, 2.3 * h, 1e-14);
      expect_contains(message_of([&] { step_of(problem, 0.); }), "above 0");
      Scene still(static_bar);
      expect_contains(message_of([&] { step_of(still.problem, 2.); }), "beyond t = 1");
      while (!has_reached(still.problem, 1.))
        advance(still.problem, 1);
      EXPECT_EQ(next_step(still.problem).end, 1.);
      EXPECT_EQ(next_step(still.problem).size, 0.);
      advance(still.problem, 1);
    }

    TEST(Problem, ConstantsMayBeGivenByCell)
    {
      Scene                     scene(static_bar), same(static_bar);
      const std::vector<double> by_cell(scene.problem.body.mesh.n_cells(), 3e5);
      scene.problem.set_material({ by_cell, {}, {} });
      same.problem.set_material({ { 3e5 }, {}, {} });
      EXPECT_EQ(scene.problem.evaluation.gradient, same.problem.evaluation.gradient);
      advance(scene.problem, 2);
      advance(same.problem, 2);
      expect_same_bytes(scene.problem.state, same.problem.state);
    }

    TEST(Problem, ChangesOutOfRangeAreRefused)
    {
      Scene      scene(static_bar), same(static_bar);
      Problem   &problem = scene.problem;
      const auto refuse  = [](const std::function<void()> &change, const std::string &part)
      { expect_contains(message_of(change), part); };
      refuse([&] { problem.set_material({ { -1. }, {}, {} }); }, "Young's modulus");
      refuse([&] { problem.set_material({ {}, { 0.5 }, {} }); }, "Poisson's ratio");
      refuse([&] { problem.set_material({ {}, {}, { 1., 2. } }); }, "2 numbers for");
      refuse([&] { problem.set_importance(0.5); }, "with examples");
      refuse([&] { problem.set_damping(1., 0.); }, "Scene = dynamic");
      advance(problem, 2);
      advance(same.problem, 2);
      expect_same_bytes(problem.state, same.problem.state);
    }

    TEST(Problem, MotionsThatAreNoneAreRefused)
    {
      Scene      scene(static_bar);
      const auto give = [](const std::size_t n, const double x)
      {
        return [=](const std::vector<dealii::Point<3>> &, double) {
          return std::vector<dealii::Tensor<1, 3>>(n, dealii::Tensor<1, 3>({ x, 0., 0. }));
        };
      };
      expect_contains(message_of([&] { scene.problem.set_motion("top", give(1, 0.)); }),
                      "Handles/Names has: left, right.");
      scene.problem.set_motion("right", give(1, 0.));
      expect_contains(message_of([&] { scene.solve(); }), "gives 1 displacements, but it holds 4");
      scene.problem.set_motion("right", give(4, std::nan("")));
      const SolveReport report = scene.problem.advance();
      expect_contains(scene.problem.failure_message(report), "Step 1 failed: Handles/right");
    }

    TEST(Problem, AnOverflowIsAFailureAndNoSolution)
    {
      Scene scene(
          "set Scene = static\n" + bar + "subsection Handles\n set Names = left, right\n"
          + held_left
          + "subsection right\n set Select = boundary 2\n set Motion = 1e160*t; 0; 0\nend\nend\n");
      const SolveReport report = scene.problem.advance();
      EXPECT_EQ(report.status, SolveStatus::failed);
      EXPECT_EQ(scene.problem.state.step, 0u);
    }

    TEST(Problem, MotionsOfHandlesThatOverlapMustAgree)
    {
      Scene scene("set Scene = static\n" + bar + "subsection Handles\n set Names = left, all left\n"
                  + held_left + "subsection all left\n set Select = boundary 1\nend\nend\n");
      scene.problem.set_motion("left",
                               [](const std::vector<dealii::Point<3>> &rest, const double t) {
                                 return std::vector<dealii::Tensor<1, 3>>(
                                     rest.size(), dealii::Tensor<1, 3>({ t, 0., 0. }));
                               });
      expect_contains(message_of([&] { scene.solve(); }), "both hold node");
    }
  } // namespace
} // namespace Exemplar::Testing
