// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/incremental_potential.h>

#include "body.h"
#include "landscape.h"
#include "scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

// What the incremental potential does about a step, beside its energy and derivatives.

namespace Exemplar::Testing
{
  namespace
  {
    const std::string held_bar = "set Scene = static\n" + bar
                                 + "subsection Handles\n set Names = left\n" + held_left + "end\n";

    bool
    is_driven(const std::string &text)
    {
      const Scene scene(text);
      EXPECT_FALSE(scene.problem.potential.is_driven(scene.problem.state, 0.));
      return scene.problem.potential.is_driven(scene.problem.state, 0.5);
    }

    TEST(StepPotential, KnowsWhatMovesFromOneTimeToAnother)
    {
      EXPECT_FALSE(is_driven(held_bar));
      EXPECT_FALSE(is_driven(held_bar + "subsection Loads\n set Gravity = 0, 0, -9.81\nend\n"));
      EXPECT_TRUE(is_driven(
          held_bar
          + "subsection Loads\n set Gravity = 0, 0, -9.81\n set Ramp = increments\nend\n"));
      const auto pulled = [](const std::string &force)
      {
        return held_bar
               + "subsection Loads\n set Names = pull\n subsection pull\n"
                 "set Select = boundary 2\n set Force = "
               + force + "\nend\nend\n";
      };
      EXPECT_FALSE(is_driven(pulled("1; 0; 0")));
      EXPECT_TRUE(is_driven(pulled("t; 0; 0")));
      EXPECT_TRUE(is_driven(
          held_bar
          + examples(two_poses
                     + "set Weights = prescribed\n set Prescribed weights = 1-t; t; 0\n")));
      EXPECT_FALSE(is_driven(
          held_bar
          + examples(two_poses
                     + "set Weights = prescribed\n set Prescribed weights = 0.5; 0.5; 0\n")));
      EXPECT_FALSE(is_driven(held_bar + examples(two_poses)));
    }

    TEST(StepPotential, OutsideOfAStepNothingIsOfTheStep)
    {
      Scene    scene("set Scene = dynamic\n" + bar + drag
                     + "subsection Time\n set Step = 0.05\n set Stiffness damping = 0.1\nend\n");
      Problem &p = scene.problem;
      ASSERT_TRUE(is_success(p.advance().status));
      EXPECT_GT(p.evaluation.elastic.energy_damping, 0.);
      EXPECT_TRUE(p.potential.changes_between_steps());
      EXPECT_NE(p.potential.inertial_positions(), nullptr);
      Evaluation outside;
      p.potential.leave_step(p.state);
      p.potential.evaluate(p.state, RotationUse::update, outside);
      EXPECT_EQ(outside.elastic.energy_damping, 0.);
      EXPECT_EQ(outside.potential, outside.elastic.energy);
      EXPECT_EQ(outside.gradient, outside.elastic.gradient);
      EXPECT_FALSE(p.potential.changes_between_steps());
      EXPECT_EQ(p.potential.inertial_positions(), nullptr);
    }

    TEST(StepPotential, AllComponentsOfTheForcesAreHeldBack)
    {
      Scene                            scene("set Scene = static\n" + bar + drag
                                             + "subsection Loads\n set Gravity = 3, -5, -9.81\nend\n");
      IncrementalPotential            &potential = scene.problem.potential;
      State                            state     = scene.problem.state;
      Evaluation                       free, held;
      std::mt19937                     generator(1);
      std::normal_distribution<double> normal;
      for (const unsigned int dof : potential.get_free_dofs().list())
        state.positions[dof] += 0.05 * normal(generator);
      potential.evaluate(state, RotationUse::update, free);
      potential.get_held_back().hold(potential.get_free_dofs(), free.gradient, state.positions);
      potential.evaluate(state, RotationUse::update, held);
      EXPECT_EQ(potential.get_free_dofs().max_magnitude(held.gradient), 0.);
      EXPECT_EQ(held.potential, free.potential); // where they are held back they have done no work
    }

    TEST(StepPotential, AStepGoesAsFarAsTheStrictestTermAllows)
    {
      const auto wall = [](const double max_step)
      {
        const auto zero = [](double) { return 0.; };
        Landscape  flat = valley(zero, zero, zero, 0.);
        flat.max_step   = [=](double, double, double, double) { return max_step; };
        return flat;
      };
      const auto max_step = [&](const std::vector<double> &walls)
      {
        std::vector<Landscape> landscapes;
        for (const double of_wall : walls)
          landscapes.push_back(wall(of_wall));
        TwoUnknowns unknowns(landscapes, 0., 0.);
        return unknowns.potential.max_step(unknowns.state.positions, unknowns.state.positions);
      };
      EXPECT_EQ(max_step({}), std::numeric_limits<double>::infinity());
      EXPECT_EQ(max_step({ 3. }), 3.);
      EXPECT_EQ(max_step({ 0.7, 0.3, 0.5 }), 0.3);
    }

    TEST(StepPotential, AMixedTangentLiesBetweenTheExactAndTheConvexOne)
    {
      Scene    scene("set Scene = static\n" + bar + drag
                     + examples(two_poses + "set Weights = free\n"));
      Problem &p     = scene.problem;
      State    state = p.state;
      p.constraints.handles.move(1., state.positions);
      state.weights = { 0.2, 0.5, 0.3 };
      Evaluation evaluation;
      p.potential.evaluate(state, RotationUse::update, evaluation);
      const auto assemble = [&](const double convexity)
      {
        std::pair<std::vector<double>, std::vector<double>> result;
        result.first.resize(p.potential.get_tangent().get_pattern().n_values());
        p.potential.get_tangent().assemble(state.positions, state.weights, convexity, result.first,
                                           result.second);
        return result;
      };
      const auto exact = assemble(0.), convex = assemble(1.), mixed = assemble(0.125);
      const auto expect_between = [](const std::vector<double> &a, const std::vector<double> &b,
                                     const std::vector<double> &between)
      {
        double scale = 0., difference = 0.;
        ASSERT_EQ(a.size(), between.size());
        for (std::size_t i = 0; i < a.size(); ++i)
        {
          scale      = std::max(scale, std::abs(a[i]));
          difference = std::max(difference, std::abs(a[i] - b[i]));
          EXPECT_NEAR(between[i], 0.875 * a[i] + 0.125 * b[i], 1e-13 * scale + 1e-300);
        }
        EXPECT_GT(difference, 1e-3 * scale); // else it proves nothing
      };
      expect_between(exact.first, convex.first, mixed.first);
      expect_between(exact.second, convex.second, mixed.second);
    }

    TEST(StepPotential, WeightsAwayFromTheirBestHaveAResidual)
    {
      Scene      scene("set Scene = static\n" + bar + drag + examples(two_poses));
      Problem   &p     = scene.problem;
      State      state = p.state;
      Evaluation evaluation;
      p.constraints.handles.move(1., state.positions);
      p.potential.minimize_over_weights(state, RotationUse::update, evaluation);
      EXPECT_LT(p.potential.residual(state, evaluation).weights, 1e-12);
      EXPECT_EQ(p.potential.residual(state, evaluation).multipliers.size(), 1u);
      state.weights = { 0.2, 0.3, 0.5 };
      p.potential.evaluate(state, RotationUse::update, evaluation);
      EXPECT_GT(p.potential.residual(state, evaluation).weights, 1e-3);
    }
  } // namespace
} // namespace Exemplar::Testing
