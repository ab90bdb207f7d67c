// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/output/diagnostics.h>

#include "scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

// Weights that remember: what a step minimises, and what it leaves behind.

namespace Exemplar::Testing
{
  namespace
  {
    const std::string short_bar = "subsection Mesh\n set Generator = box\n set Box size = 3, 1, 1\n"
                                  " set Box cells = 3, 1, 1\nend\n";

    const std::string poses = "set Pose functions = 1.3*x; y/1.1; z/1.1 | "
                              "x; y; z+0.2*x^2\n set Importance = 0.9\n";

    /// The end is pulled towards the first pose and back, or as `motion` says.
    std::string
    pulled(const std::string &motion = "0.24*x*(1-abs(2*t-1)); 0; 0")
    {
      return "subsection Handles\n set Names = left, right\n" + held_left
             + "subsection right\n set Select = boundary 2\n set Motion = " + motion
             + "\n set Components = x\nend\nend\n";
    }

    std::string
    statics(const std::string &memory, const unsigned int increments)
    {
      return "set Scene = static\n" + short_bar + pulled() + examples(poses + memory)
             + "subsection Time\n set Increments = " + std::to_string(increments) + "\nend\n";
    }

    std::string
    dynamics(const std::string &memory,
             const std::string &time,
             const std::string &solver = "newton")
    {
      return "set Scene = dynamic\n" + short_bar + pulled("0.24*x*sin(2*t)^2; 0; 0")
             + examples(poses + memory) + "subsection Time\n" + time + "end\n"
             + "subsection Solver\n set Method = " + solver + "\nend\n";
    }

    struct Balance
    {
      double              work = 0., stored = 0., dissipated = 0.;
      double              work_of_mean_forces = 0.; ///< where `work` has those at the ends of steps
      std::vector<double> at_full_pull, at_end;
      unsigned int        iterations = 0;

      double
      error() const
      {
        return std::abs(work - stored - dissipated) / dissipated;
      }
    };

    Balance
    balance_of(const std::string &scene_text)
    {
      Scene        scene(scene_text);
      Problem     &p = scene.problem;
      Diagnostics  diagnostics(p);
      Balance      balance;
      const double before = p.evaluation.elastic.energy;
      while (p.state.step < p.time_axis.n_steps())
      {
        const Vector      from = p.state.positions, forces = p.evaluation.gradient;
        const SolveReport report = p.advance();
        EXPECT_TRUE(is_success(report.status)) << report.failure;
        EXPECT_LE(report.kkt_residual, 1e-8);
        balance.iterations += report.iterations;
        diagnostics.add_step();
        for (const unsigned int dof : p.constraints.handles.held_dofs())
          balance.work_of_mean_forces += 0.5 * (forces[dof] + p.evaluation.gradient[dof])
                                         * (p.state.positions[dof] - from[dof]);
        if (2 * p.state.step == p.time_axis.n_steps())
          balance.at_full_pull = p.state.weights;
      }
      balance.at_end     = p.state.weights;
      balance.work       = diagnostics.get_work().handles;
      balance.stored     = p.evaluation.elastic.energy - before;
      balance.dissipated = p.state.dissipated;
      return balance;
    }

    TEST(WeightMemory, WorkIsWhatIsStoredAndDissipatedInTheLimitOfSmallIncrements)
    {
      const std::string memory = "set Yield = 3000\n";
      const Balance     coarse = balance_of(statics(memory, 50)),
                    fine       = balance_of(statics(memory, 100)),
                    finest     = balance_of(statics(memory, 200));
      EXPECT_GT(finest.at_full_pull[1], 0.3); // else it proves nothing
      EXPECT_GT(finest.dissipated, 1000.);
      EXPECT_NEAR(coarse.error() / fine.error(), 2., 0.4);
      EXPECT_NEAR(fine.error() / finest.error(), 2., 0.4);
      EXPECT_LT(std::abs(finest.work_of_mean_forces - finest.stored - finest.dissipated),
                1e-3 * finest.work_of_mean_forces);
      EXPECT_LE(finest.iterations, 4 * 200u);
    }

    TEST(WeightMemory, ABodyStaysAsFarAsItsYieldHoldsIt)
    {
      const Balance none = balance_of(statics("", 20)),
                    some = balance_of(statics("set Yield = 3000\n", 20)),
                    huge = balance_of(statics("set Yield = 1e12\n", 20));
      EXPECT_GT(none.at_full_pull[1], some.at_full_pull[1]);
      EXPECT_EQ(none.dissipated, 0.);
      EXPECT_GT(some.at_end[1], 0.02);
      EXPECT_EQ(huge.at_full_pull, (std::vector<double>{ 1., 0., 0. }));
      EXPECT_EQ(huge.at_end, huge.at_full_pull);
      EXPECT_EQ(huge.dissipated, 0.);
      // as if they were prescribed
      const std::string rest = "set Weights = prescribed\n set Prescribed weights = 1; 0; 0\n";
      EXPECT_NEAR(huge.work, balance_of(statics(rest, 20)).work, 1e-9 * std::abs(none.work) + 1e-6);
    }

    TEST(WeightMemory, NoYieldIsNoMemory)
    {
      Scene       without(dynamics("", "set Step = 0.05\n set End = 0.5\n"));
      Scene       zero(dynamics("set Yield = 0\n set Creep viscosity = 0\n",
                                "set Step = 0.05\n set End = 0.5\n"));
      const State a = without.solve(), b = zero.solve();
      EXPECT_TRUE(a == b);
      EXPECT_FALSE(zero.problem.potential.get_weights().get_memory().in_use());
      EXPECT_FALSE(zero.problem.examples.weights.get_memory().in_use());
    }

    TEST(WeightMemory, RegionsAreHeldByTheirOwnVolume)
    {
      Scene               scene("set Scene = static\n" + short_bar + pulled()
                                + examples(poses + "set Yield = 7\n"));
      const WeightMemory &memory = scene.problem.examples.weights.get_memory();
      const double moved = memory.energy({ 0.5, 0.3, 0.2 }), still = memory.energy({ 1., 0., 0. });
      EXPECT_NEAR(moved, 7. * 3. * 1., 1e-12);
      EXPECT_EQ(still, 0.);
    }

    // What a step minimises

    struct InStep
    {
      explicit InStep(const std::string &memory, const std::string &time = "set Step = 0.05\n")
          : scene(dynamics(memory, time)), p(scene.problem)
      {
        for (int i = 0; i < 6; ++i)
          EXPECT_TRUE(is_success(p.advance().status));
        p.potential.begin_step(p.state, 0.05);
        at      = p.state;
        at.time = 0.35;
        p.potential.set_time(at.time, at);
        std::mt19937                     generator(1);
        std::normal_distribution<double> normal;
        for (const unsigned int dof : p.potential.get_free_dofs().list())
        {
          at.positions[dof] += 0.01 * normal(generator);
          direction.push_back(normal(generator));
        }
      }

      Evaluation
      minimized(const double length)
      {
        State beside = at;
        p.potential.get_free_dofs().add(length, direction, beside.positions);
        Evaluation evaluation;
        p.potential.minimize_over_weights(beside, RotationUse::update, evaluation);
        weights  = beside.weights;
        residual = p.potential.residual(beside, evaluation).weights;
        return evaluation;
      }

      std::vector<double>
      free_gradient(const double length)
      {
        std::vector<double> gradient;
        p.potential.get_free_dofs().gather(minimized(length).gradient, gradient);
        return gradient;
      }

      Scene               scene;
      Problem            &p;
      State               at;
      std::vector<double> direction, weights;
      double              residual = 0.;
    };

    const std::vector<std::string> memories
        = { "set Yield = 500\n", "set Yield = 1e5\n", "set Creep viscosity = 2000\n",
            "set Yield = 300\n set Creep viscosity = 1000\n" };

    TEST(WeightMemory, ForcesAreTheDerivativeOfWhatAStepMinimises)
    {
      for (const std::string scheme : { "implicit euler", "bdf2" })
        for (const std::string &memory : memories)
        {
          InStep              step(memory, "set Step = 0.05\n set Scheme = " + scheme + "\n");
          const Evaluation    at = step.minimized(0.);
          const double        h  = 3e-6;
          std::vector<double> gradient;
          step.p.potential.get_free_dofs().gather(at.gradient, gradient);
          const double slope
              = std::inner_product(gradient.begin(), gradient.end(), step.direction.begin(), 0.);
          EXPECT_LT(step.residual, 1e-10);
          EXPECT_NEAR((step.minimized(h).potential - step.minimized(-h).potential) / (2. * h),
                      slope, 1e-7 * std::abs(slope))
              << memory;
          EXPECT_GT(std::abs(slope), 1.);
        }
    }

    TEST(WeightMemory, ByWeightsToo)
    {
      InStep     step(memories[3], "set Step = 0.05\n set Scheme = bdf2\n");
      State      at = step.at;
      Evaluation evaluation;
      at.weights           = { 0.5, 0.2, 0.3 }; // all off their kinks
      const auto potential = [&](const unsigned int i, const double change)
      {
        State beside = at;
        beside.weights[i] += change;
        step.p.potential.evaluate(beside, RotationUse::update, evaluation);
        return evaluation.potential;
      };
      step.p.potential.evaluate(at, RotationUse::update, evaluation);
      const std::vector<double> gradient = evaluation.elastic.weight_gradient;
      for (unsigned int i = 0; i < 3; ++i)
      {
        const auto slopes
            = step.p.examples.weights.get_memory().slopes(i, at.weights[i], gradient[i]);
        EXPECT_EQ(slopes.up, slopes.down);
        EXPECT_NEAR((potential(i, 1e-5) - potential(i, -1e-5)) / 2e-5, slopes.up,
                    1e-6 * std::abs(slopes.up));
      }
    }

    TEST(WeightMemory, TheReducedTangentIsTheDerivativeOfTheReducedForces)
    {
      for (const std::string &memory : memories)
      {
        InStep       step(memory);
        const double h             = 1e-6;
        Evaluation   at            = step.minimized(0.);
        step.at.weights            = step.weights;
        const unsigned int n_stuck = [&]
        {
          unsigned int n = 0;
          for (unsigned int i = 0; i < 3; ++i)
            n += step.weights[i] == step.p.state.weights[i] ? 1 : 0;
          return n;
        }();
        EXPECT_EQ(n_stuck == 3, memory == memories[1]);
        at = step.minimized(0.); // with its rotations
        step.p.system.factorize(step.at.positions, step.at.weights, 0.);
        const std::vector<double> above = step.free_gradient(h), below = step.free_gradient(-h);
        Vector                    change(at.gradient.size());
        std::vector<double>       difference(above.size());
        for (std::size_t i = 0; i < difference.size(); ++i)
          difference[i] = -0.5 * (above[i] - below[i]);
        step.p.potential.get_free_dofs().add(1., difference, change);
        const BorderedVector found
            = step.p.system.solve(step.at, change, at.elastic.weight_gradient);
        double error = 0., size = 0.;
        for (std::size_t i = 0; i < step.direction.size(); ++i)
        {
          error = std::max(error, std::abs(found.positions[i] - h * step.direction[i]));
          size  = std::max(size, std::abs(h * step.direction[i]));
        }
        EXPECT_LT(error, 1e-5 * size) << memory;
      }
    }

    // What a step leaves behind

    TEST(WeightMemory, ARefusedStepGivesItBack)
    {
      const std::string scene_text = "set Scene = static\n" + short_bar + pulled("0.9*x*t; 0; 0")
                                     + examples(poses + "set Yield = 3000\n")
                                     + "subsection Time\n set Increments = 3\nend\n";
      Scene       refused(scene_text,
                          { "Solver/Maximum iterations=1", "Handles/right/Motion=90*x*t; 0; 0" });
      const State before = refused.problem.state;
      EXPECT_FALSE(is_success(refused.problem.advance().status));
      EXPECT_TRUE(refused.problem.state == before);
      // in halves an increment ends where it ends in one: both remember the weights at its start
      Scene whole(scene_text), halves(scene_text, { "Solver/Maximum iterations=3" });
      ASSERT_TRUE(is_success(whole.problem.advance().status));
      ASSERT_TRUE(is_success(halves.problem.advance().status));
      EXPECT_LT(whole.problem.state.weights[0], 0.9);
      for (unsigned int i = 0; i < 3; ++i)
        EXPECT_NEAR(halves.problem.state.weights[i], whole.problem.state.weights[i], 1e-6);
      EXPECT_NEAR(halves.problem.state.dissipated, whole.problem.state.dissipated,
                  1e-6 * whole.problem.state.dissipated);
    }

    TEST(WeightMemory, CreepHasTheOrderOfTheScheme)
    {
      // smooth in time: no weight meets a bound
      const auto weight = [](const std::string &scheme, const double step)
      {
        Scene scene("set Scene = dynamic\n" + short_bar + pulled("0.1*x*t^2; 0; 0")
                    + examples("set Pose functions = 1.3*x; y; z\n set Creep viscosity = 20000\n")
                    + "subsection Time\n set Scheme = " + scheme
                    + "\n set Stiffness damping = 0.05\n set End = 0.5\n set Step = "
                    + std::to_string(step)
                    + "\nend\nsubsection Solver\n set Method = newton\nend\n");
        return scene.solve().weights[1];
      };
      for (const auto &[scheme, order] :
           { std::pair<std::string, double>{ "implicit euler", 1. }, { "bdf2", 2. } })
      {
        const double finest = weight(scheme, 0.003125), coarse = weight(scheme, 0.025),
                     fine = weight(scheme, 0.0125);
        EXPECT_GT(finest, 0.01);
        const double ratio    = (coarse - finest) / (fine - finest);
        const double expected = (std::pow(8., order) - 1.)
                                / (std::pow(4., order) - 1.); // the last one has an error, too
        EXPECT_NEAR(ratio / expected, 1., 0.2) << scheme;
      }
    }

    TEST(WeightMemory, AllMethodsFindTheSame)
    {
      const std::string time = "set Step = 0.05\n set End = 1.5\n";
      for (const std::string &memory : memories)
      {
        Scene newton(dynamics(memory, time)),
            quasi(dynamics(memory, time, "quasi newton"), { "Solver/Step tolerance=1e-8" });
        const State a = newton.solve(), b = quasi.solve();
        for (unsigned int i = 0; i < 3; ++i)
          EXPECT_NEAR(a.weights[i], b.weights[i], 1e-5);
        EXPECT_LT(max_difference(a.positions, b.positions), 1e-5);
        EXPECT_NEAR(a.dissipated, b.dissipated, 1e-4 * a.dissipated);
      }
    }

    TEST(WeightMemory, ADynamicBodyGainsNoEnergy)
    {
      // let go from a pull: energies and what is dissipated never grow together
      for (const std::string &memory : memories)
      {
        Scene scene("set Scene = dynamic\n" + short_bar + "subsection Handles\n set Names = left\n"
                    + held_left + "end\n" + examples(poses + memory)
                    + "subsection Initial\n set Pose function = 1.3*x; y; z+0.05*x^2\nend\n"
                      "subsection Time\n set Step = 0.02\n set End = 1\nend\n"
                      "subsection Solver\n set Method = newton\nend\n");
        Problem &p     = scene.problem;
        double   total = p.evaluation.elastic.energy;
        while (p.state.step < p.time_axis.n_steps())
        {
          ASSERT_TRUE(is_success(p.advance().status));
          const double now = p.evaluation.elastic.energy
                             + p.actions.mass->motion_sums(p.state).kinetic_energy
                             + p.state.dissipated;
          EXPECT_LE(now, total * (1. + 1e-9));
          total = now;
        }
        EXPECT_EQ(p.state.dissipated > 1., memory != memories[1]) << memory;
      }
    }
  } // namespace
} // namespace Exemplar::Testing
