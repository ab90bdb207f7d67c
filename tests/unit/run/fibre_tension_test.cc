// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/potential/fibre_tension_term.h>
#include <exemplar/run/adjoint/trajectory_gradients.h>
#include <exemplar/run/output/diagnostics.h>
#include <exemplar/run/problem/state_review.h>

#include "expect_contains.h"
#include "scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

// Bodies of E = 1e6 Pa whose fibres pull: closed forms of contraction, derivatives against differences.
namespace Exemplar::Testing
{
  namespace
  {
    using Strings = std::vector<std::string>;

    const std::string active_cube = Verification::box({ { 1., 1., 1. } }, { { 2, 2, 2 } });

    const std::string solved
        = "subsection Solver\n set Tolerance = 1e-12\n set Step tolerance = 1e-12\nend\n";

    std::string
    material(const std::string &keys)
    {
      return "subsection Material\n" + keys + "end\n";
    }

    const std::string pulling = "set Fibre direction = 1; 0; 0\nset Fibre tension = 2e5*t\n";

    std::string
    statics(const std::string &rest, const unsigned int increments = 1)
    {
      return "set Scene = static\nsubsection Time\n set Increments = " + std::to_string(increments)
             + "\nend\n" + solved + rest;
    }

    /// Three faces slide on planes; the right one is free, or held in x.
    std::string
    sliding(const bool holds_right)
    {
      return "subsection Handles\n set Names = left, front, bottom"
             + std::string(holds_right ? ", right" : "")
             + "\n subsection left\n set Select = boundary 1\n set Components = x\n end\n"
               " subsection front\n set Select = boundary 3\n set Components = y\n end\n"
               " subsection bottom\n set Select = boundary 5\n set Components = z\n end\n"
             + (holds_right
                    ? " subsection right\n set Select = boundary 2\n set Components = x\n end\n"
                    : "")
             + "end\n";
    }

    const std::string clamped_left
        = "subsection Handles\n set Names = left\n" + held_left + "end\n";

    double
    column_of(const Problem &problem, const std::string &name)
    {
      for (const StatisticsCell &cell : Diagnostics(problem).row(problem.state, SolveReport()))
        if (cell.column == name)
          return std::get<double>(cell.value);
      return std::nan("");
    }

    /// A refusal of a scene; empty if there is none.
    std::string
    refusal(const std::string &text, const Strings &overrides = {})
    {
      try
      {
        Scene(text, overrides);
      }
      catch (const std::exception &error)
      {
        return error.what();
      }
      return "";
    }

    TEST(FibreTension, AFreeCubeShortensByTensionOverStiffness)
    {
      for (const std::string law : { "corotational", "linear" })
        for (const std::string element : { "P1", "P2" })
          for (const double alpha : { 0., 1e6 })
            for (const std::string nu : { "0", "0.3", "0.49" })
            {
              if (law == "linear" && alpha > 0.)
                continue;
              Scene scene(statics(active_cube + sliding(false) + material(pulling)),
                          { "Material/Poisson's ratio=" + nu, "Model/Strain=" + law,
                            "Model/Element=" + element,
                            "Material/Fibre stiffness=" + std::to_string(alpha) });
              scene.solve();
              const auto   u   = Verification::mean_displacement(scene.problem, scene.problem.state,
                                                                 "boundary 2");
              const double end = Verification::mean_displacement(scene.problem, scene.problem.state,
                                                                 "boundary 4")[1];
              EXPECT_NEAR(u[0], -2e5 / (1e6 + alpha), 1e-9) << law << element << alpha << nu;
              EXPECT_NEAR(end, std::stod(nu) * 2e5 / (1e6 + alpha), 1e-9)
                  << law << element << alpha << nu;
            }
    }

    TEST(FibreTension, AHeldCubePullsWithTensionTimesArea)
    {
      for (const std::string element : { "P1", "P2" })
      {
        Scene scene(statics(active_cube + sliding(true) + material(pulling)),
                    { "Model/Element=" + element, "Material/Poisson's ratio=0.45" });
        scene.solve();
        // a cube free at its sides is pulled to nothing: it stays as it is
        EXPECT_NEAR(column_of(scene.problem, "reaction_right_x"), 2e5, 2e-4);
        EXPECT_LT(max_difference(scene.problem.state.positions,
                                 scene.problem.body.fe_space.rest_positions()),
                  1e-10);
      }
    }

    TEST(FibreTension, AClampedBarStaysAndADynamicOneComesToTheSameForce)
    {
      const std::string held = "subsection Handles\n set Names = left, right\n" + held_left
                               + "subsection right\n set Select = boundary 2\nend\nend\n";
      Scene scene("set Scene = dynamic\nsubsection Time\n set Step = 0.1\n set End = 1\nend\n"
                  + solved + bar + held + material(pulling));
      scene.solve();
      EXPECT_NEAR(column_of(scene.problem, "reaction_right_x"), 2e5, 2e-4);
    }

    TEST(FibreTension, ACubeWithoutStiffnessHangsByItsFibresTension)
    {
      // a weight pulls to the right with less, the same, more force than the tension
      for (const double force : { 1e5, 2e5, 3e5 })
      {
        Scene scene(statics(active_cube + sliding(false) + material(pulling)
                            + "subsection Loads\n set Names = tip\n subsection tip\n set Select = "
                              "boundary 2\n set Force = "
                            + std::to_string(force) + "*t; 0; 0\n end\nend\n"),
                    { "Material/Poisson's ratio=0" });
        scene.solve();
        const auto u
            = Verification::mean_displacement(scene.problem, scene.problem.state, "boundary 2");
        EXPECT_NEAR(u[0], (force - 2e5) / 1e6, 1e-9);
      }
    }

    TEST(FibreTension, ACurveGivesTheLengthWhereForcesBalance)
    {
      Scene scene(
          statics(active_cube + sliding(false) + material(pulling)),
          { "Material/Fibre tension curve=0.5: 0; 1: 1; 1.5: 0", "Material/Poisson's ratio=0" });
      scene.solve();
      // E (l - 1) + T 2 (l - 1/2) = 0
      const double l = (1e6 + 2e5) / (1e6 + 4e5);
      EXPECT_NEAR(
          Verification::mean_displacement(scene.problem, scene.problem.state, "boundary 2")[0],
          l - 1., 1e-9);
    }

    TEST(FibreTension, CurvesAreIntegralsAndSmoothAtTheLeastStretch)
    {
      for (const std::string text :
           { "", "0.05: 2; 0.6: 0.3; 1: 1; 1.4: 0.2", "0.5: 0; 1: 1; 1.5: 0" })
      {
        const TensionCurve curve(text, "curve");
        EXPECT_NEAR(curve.at(1.).energy, 0., 1e-15);
        EXPECT_EQ(curve.at(1.).force, 1.);
        for (const double s : { 0.02, 0.07, 0.13, 0.55, 0.8, 1.2, 1.45, 2. })
        {
          const double h = 1e-5;
          EXPECT_NEAR((curve.at(s + h).energy - curve.at(s - h).energy) / (2. * h),
                      curve.at(s).force, 1e-9)
              << text << s;
          EXPECT_NEAR((curve.at(s + h).force - curve.at(s - h).force) / (2. * h), curve.at(s).slope,
                      1e-7)
              << text << s;
        }
        const auto below = curve.at(0.1 - 1e-12), above = curve.at(0.1 + 1e-12);
        EXPECT_NEAR(below.energy, above.energy, 1e-11);
        EXPECT_NEAR(below.force, above.force, 1e-10);
      }
      for (const std::string wrong :
           { "1", "1: 1", "1: 1; 0.5: 0", "0: 1; 1: 1", "1: -1; 2: 0", "1: 1; 2", "1: 1; x: 0",
             "1: 1; 2: inf", "1 1; 2 0", "1: 1; 2: 1; " })
        EXPECT_THROW(TensionCurve(wrong, "curve"), UserError) << wrong;
    }

    /// Phi at random places, with the term's parts: energies, forces, tangents.
    void
    check_derivatives(const Strings &overrides)
    {
      Scene                                  scene(statics(active_cube + clamped_left
                                                           + material("set Fibre direction = 1 + y; 0.4*x; z - 0.3\nset Fibre "
                                                                                                       "tension = 3e5 + 1e5*x*t\n")),
                                                   overrides);
      Laboratory                            &lab = scene.problem.laboratory();
      std::mt19937                           random(1);
      std::uniform_real_distribution<double> some(-1., 1.);
      Place                                  at = lab.here();
      Vector                                 direction(at.positions.size());
      for (double &x : at.positions)
        x += 0.05 * some(random);
      for (double &x : direction)
        x = some(random);
      const auto at_distance = [&](const double h)
      {
        Place there = at;
        there.positions.add(h, direction);
        return there;
      };
      const Vector gradient = lab.evaluate(at).gradient;
      const double h        = 1e-5;
      const double up       = lab.evaluate(at_distance(h)).potential,
                   down     = lab.evaluate(at_distance(-h)).potential;
      EXPECT_NEAR((up - down) / (2. * h), gradient * direction,
                  1e-7 * std::abs(gradient * direction));
      const Vector plus     = lab.evaluate(at_distance(h)).gradient,
                   minus    = lab.evaluate(at_distance(-h)).gradient;
      const RowMatrix exact = lab.hessian(at, Tangent::exact);
      for (unsigned int i = 0; i < gradient.size(); ++i)
      {
        double row = 0.;
        for (auto k = exact.row_start[i]; k < exact.row_start[i + 1]; ++k)
          row += exact.value[k] * direction[exact.column[k]];
        EXPECT_NEAR((plus[i] - minus[i]) / (2. * h), row, 1e-7 * 1e6) << i;
      }
    }

    TEST(FibreTension, ForcesAndTangentsAreDerivatives)
    {
      check_derivatives({});
      check_derivatives({ "Model/Element=P2" });
      check_derivatives({ "Model/Dilatation=patches", "Material/Poisson's ratio=0.49" });
      check_derivatives({ "Material/Fibre stiffness=2e6" });
      check_derivatives({ "Material/Fibre tension curve=0.5: 0; 0.97: 1; 1.9: 0.2" });
    }

    TEST(FibreTension, AFreeBodyFeelsNoForceAndNoTorque)
    {
      Scene            scene(statics(active_cube + clamped_left
                                     + material("set Fibre direction = 1 + y; 0.4*x; z - 0.3\nset Fibre "
                                                           "tension = 3e5 + 1e5*x\n")));
      Problem         &problem = scene.problem;
      FibreTensionTerm term(problem.body.material, problem.body.fe_space,
                            problem.actions.held_tensions);
      term.set_time(0.);
      std::mt19937                           random(2);
      std::uniform_real_distribution<double> some(-1., 1.);
      Vector                                 x = problem.state.positions;
      for (double &value : x)
        value += 0.2 * some(random);
      ElasticEvaluation start;
      start.gradient.reinit(x.size());
      start.force_scale.reinit(x.size() / 3);
      ElasticSums sums(start);
      term.add({ x, {} }, sums);
      const double scale = sums->gradient.linfty_norm();
      for (int c = 0; c < 3; ++c)
      {
        EXPECT_NEAR(Verification::total(sums->gradient)[c], 0., 1e-9 * scale);
        EXPECT_NEAR(Verification::torque(x, sums->gradient)[c], 0., 1e-9 * scale);
      }
    }

    double
    tip(const Problem &problem)
    {
      return problem.state.positions[problem.state.positions.size() - 1];
    }

    Direction
    by_tip(const Problem &problem)
    {
      Direction by{ Vector(problem.state.positions.size()),
                    std::vector<double>(problem.state.weights.size(), 0.) };
      by.positions[by.positions.size() - 1] = 1.;
      return by;
    }

    const std::string bending
        = bar + clamped_left
          + material("set Fibre direction = 1; 0; 0\nset Fibre tension = 1e5*t*max(0, z)\n");

    TEST(FibreTension, GradientsByTensionsAreThoseOfDifferences)
    {
      for (const Strings &overrides :
           { Strings{}, Strings{ "Model/Element=P2" },
             Strings{ "Model/Dilatation=patches", "Material/Poisson's ratio=0.49" },
             Strings{ "Material/Fibre stiffness=1e6" } })
      {
        Scene               scene(statics(bending), overrides);
        auto               &problem = scene.problem;
        std::vector<double> T(problem.body.fe_space.n_cells());
        for (std::size_t cell = 0; cell < T.size(); ++cell)
          T[cell] = 1e5 + 3e3 * cell;
        const auto solve = [&](const std::vector<double> &tensions)
        {
          problem.set_tension(tensions);
          for (unsigned int again = 0; again < 2; ++again)
            EXPECT_TRUE(is_success(problem.advance({ 1., 1. }).status));
          return tip(problem);
        };
        solve(T);
        const Gradients found = gradients(problem, by_tip(problem));
        ASSERT_TRUE(found.tension);
        double size = 0.;
        for (const double value : *found.tension)
          size = std::max(size, std::abs(value));
        for (const unsigned int cell : { 0u, 7u, 12u })
        {
          const double h  = 300.;
          auto         up = T, down = T;
          up[cell] += h;
          down[cell] -= h;
          EXPECT_NEAR((solve(up) - solve(down)) / (2. * h), (*found.tension)[cell], 1e-6 * size)
              << cell;
        }
      }
    }

    TEST(FibreTension, GradientsOfEachStepAreThoseOfDifferences)
    {
      Scene    scene("set Scene = dynamic\nsubsection Time\n set Step = 0.02\n set End = 0.4\nend\n"
                     + solved + bending);
      Problem &problem              = scene.problem;
      const State        start      = problem.state;
      const unsigned int n          = problem.body.fe_space.n_cells();
      const auto         tension_of = [&](const unsigned int step)
      { return std::vector<double>(n, 2e4 * (1. + std::sin(0.7 * step))); };
      const auto run = [&](const unsigned int changed, const double by, RecordedSteps *recorded)
      {
        problem.resume_from(start);
        if (recorded != nullptr)
          problem.on_step = [&, recorded](const State &from, const double size)
          { recorded->add(problem, from, size); };
        for (unsigned int step = 0; step < 20; ++step)
        {
          std::vector<double> T = tension_of(step);
          if (step == changed)
            T[5] += by;
          problem.set_tension(T);
          EXPECT_TRUE(is_success(problem.advance().status));
        }
        problem.on_step = nullptr;
        return tip(problem);
      };
      RecordedSteps recorded(problem);
      run(0, 0., &recorded);
      std::vector<StateDerivatives> by(20);
      const Direction               of_end = by_tip(problem);
      by[19].positions
          = dealii::ArrayView<const double>(of_end.positions.begin(), of_end.positions.size());
      problem.set_tension({}); // the steps keep theirs
      const TrajectoryGradients found = trajectory_gradients(problem, recorded, by);
      ASSERT_EQ(found.tension.size(), 20u);
      double size = 0.;
      for (const auto &of_step : found.tension)
        size = std::max(size, std::abs(of_step[5]));
      EXPECT_GT(size, 0.);
      for (const unsigned int step : { 0u, 9u, 17u, 19u })
      {
        const double h = 1000.;
        EXPECT_NEAR((run(step, h, nullptr) - run(step, -h, nullptr)) / (2. * h),
                    found.tension[step][5], 1e-6 * size)
            << step;
      }
    }

    TEST(FibreTension, WhatItCannotBeIsRefusedInWords)
    {
      const std::string good = statics(active_cube + sliding(false) + material(pulling));
      EXPECT_EQ(refusal(good), "");
      expect_contains(refusal(good, { "Material/Fibre tension=0.3-t" }), "fibres do not push");
      expect_contains(refusal(good, { "Material/Fibre tension=-5" }), "fibres do not push");
      expect_contains(refusal(good, { "Material/Fibre direction=" }),
                      "Material/Fibre tension needs to know the direction");
      expect_contains(refusal(good, { "Material/Fibre tension=2*q" }), "Material/Fibre tension");
      expect_contains(refusal(good, { "Material/Fibre tension curve=1: 2" }),
                      "Fibre tension curve = '1: 2'");
      expect_contains(refusal(good, { "Loads/Balanced=true", "Loads/Gravity=0, 0, -1" }),
                      "Loads/Balanced = false");
      expect_contains(refusal(good, { "Model/Gradient=frozen" }), "Gradient = consistent");
      expect_contains(refusal(good, { "Solver/Method=fixed point" }), "Solver/Method = auto");
      Scene scene(good);
      EXPECT_THROW(scene.problem.set_tension({ -1. }), UserError);
      EXPECT_THROW(scene.problem.set_tension({ 1., 2. }), UserError);
      EXPECT_THROW(Scene(statics(active_cube + sliding(false))).problem.set_tension({ 1. }), UserError);
    }

    TEST(FibreTension, GreatTensionsAreWarnedOf)
    {
      const auto warnings = [](const std::string &tension)
      {
        Strings of_tension;
        for (const std::string &warning : Scene(statics(active_cube + sliding(false) + material(pulling)),
                                                { "Material/Fibre tension=" + tension })
                                              .problem.warnings())
          if (warning.find("Material/Fibre tension is up to") == 0)
            of_tension.push_back(warning);
        return of_tension;
      };
      EXPECT_TRUE(warnings("7e5").empty());
      ASSERT_EQ(warnings("8.5e5*t").size(), 1u);
      expect_contains(warnings("8.5e5*t")[0], "0.15 of its length");
      Scene scene(statics(active_cube + sliding(false) + material(pulling), 4),
                  { "Material/Fibre tension=9.7e5", "Material/Poisson's ratio=0" });
      scene.solve();
      bool is_said = false;
      for (const std::string &warning : StateReview(scene.problem).warnings())
        is_said |= warning.find("shorter along their fibres") != std::string::npos;
      EXPECT_TRUE(is_said);
      // the parabola: E (l - 1) + T l / 0.1 = 0
      EXPECT_NEAR(
          Verification::mean_displacement(scene.problem, scene.problem.state, "boundary 2")[0] + 1.,
          1. / (1. + 9.7), 1e-8);
    }

    TEST(FibreTension, StandsBesideOtherLaws)
    {
      for (const Strings &beside :
           { Strings{ "Material/Yield stress=1e9" },
             Strings{ "Material/Relaxation time=1e9", "Material/Relaxing share=0.5" },
             Strings{ "Model/Background=neo-hookean" }, Strings{ "Model/Strain=green" } })
      {
        Scene scene(statics(active_cube + sliding(false) + material(pulling)), beside);
        scene.solve();
        EXPECT_LT(
            Verification::mean_displacement(scene.problem, scene.problem.state, "boundary 2")[0],
            -0.1)
            << beside[0];
      }
    }
  } // namespace
} // namespace Exemplar::Testing
