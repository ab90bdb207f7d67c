// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/solvers/step_system.h>

#include "body.h"
#include "scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace Exemplar::Testing
{
  namespace
  {
    const std::string linear_bar = "set Scene = static\n" + bar + drag
                                   + examples(two_poses + "set Weights = free\n")
                                   + "subsection Model\n set Strain = linear\nend\n";

    /// Of the system with its factor at a state.
    BorderedVector
    step_from(Problem &problem, State &state, Evaluation &evaluation)
    {
      problem.potential.set_time(1., state);
      problem.constraints.handles.move(1., state.positions);
      problem.potential.evaluate(state, RotationUse::update, evaluation);
      problem.system.factorize(state.positions, state.weights, 1.);
      return problem.system.solve(state, evaluation);
    }

    TEST(StepSystem, AStepLeadsToTheMinimumOfAQuadraticEnergy)
    {
      Scene                scene(linear_bar);
      Problem             &p     = scene.problem;
      State                state = p.state;
      Evaluation           evaluation;
      const BorderedVector step   = step_from(p, state, evaluation);
      const double         before = p.potential.get_free_dofs().max_magnitude(evaluation.gradient);
      p.system.add(step, state);
      p.potential.evaluate(state, RotationUse::update, evaluation);
      EXPECT_LT(p.potential.get_free_dofs().max_magnitude(evaluation.gradient), 1e-9 * before);
      EXPECT_LT(p.potential.residual(state, evaluation).weights, 1e-9);
    }

    TEST(StepSystem, AStepRestoresTheSumOfTheWeights)
    {
      Scene      scene(linear_bar);
      State      state = scene.problem.state;
      Evaluation evaluation;
      state.weights             = { 0.5, 0.2, 0.1 };
      const BorderedVector step = step_from(scene.problem, state, evaluation);
      EXPECT_NEAR(std::accumulate(step.weights.begin(), step.weights.end(), 0.), 0.2, 1e-12);
      scene.problem.system.add(step, state);
      EXPECT_NEAR(std::accumulate(state.weights.begin(), state.weights.end(), 0.), 1., 1e-12);
    }

    TEST(StepSystem, TheSlopeIsTheDerivativeOfThePotentialAlongAStep)
    {
      Scene                scene("set Scene = static\n" + bar + drag);
      Problem             &p     = scene.problem;
      State                state = p.state;
      Evaluation           evaluation, beside;
      const BorderedVector step   = step_from(p, state, evaluation);
      const double         slope  = p.system.slope(evaluation, step);
      const Vector         way    = p.system.displacement(state, step);
      double               change = 0.;
      for (const double side : { 1e-5, -1e-5 })
      {
        State moved = state;
        moved.positions.add(side, way);
        p.potential.evaluate(moved, RotationUse::update, beside);
        change += beside.potential * (side > 0. ? 1. : -1.);
      }
      EXPECT_LT(slope, 0.);
      EXPECT_NEAR(change / 2e-5, slope, 1e-5 * std::abs(slope));
      for (unsigned int dof = 0; dof < way.size(); ++dof)
        if (p.constraints.free_dofs.free_index(dof) == FreeDofs::held)
        {
          EXPECT_EQ(way[dof], 0.);
        }
    }

    TEST(StepSystem, StepsOfABodyThatNothingHoldsDoNotTurnIt)
    {
      Scene      scene("set Scene = interpolation\n" + bar
                       + examples("set Pose functions = " + twist(90.)
                                  + "\n set Prescribed weights = 1-t; t\n"));
      Problem   &p     = scene.problem;
      State      state = p.state;
      Evaluation evaluation;
      p.potential.set_time(0.2, state);
      p.potential.evaluate(state, RotationUse::update, evaluation);
      p.system.factorize(state.positions, state.weights, 1.);
      const Vector way = p.system.displacement(state, p.system.solve(state, evaluation));
      ASSERT_GT(way.linfty_norm(), 1e-3);
      Vector rest = way;
      remove_rigid_motion(state.positions, rest, Exchange::serial());
      EXPECT_LT(max_difference(way, rest), 1e-12 * way.linfty_norm());
    }

    TEST(StepSystem, FactorsAreNumbered)
    {
      Scene      scene(linear_bar);
      State      state = scene.problem.state;
      Evaluation evaluation;
      const auto before = scene.problem.system.n_factorizations();
      step_from(scene.problem, state, evaluation);
      EXPECT_EQ(scene.problem.system.n_factorizations(), before + 1);
    }

    TEST(StepSystem, CholeskyAndUmfpackAgree)
    {
      const std::string text
          = "set Scene = static\n" + bar + drag
            + examples("set Pose functions = " + twist(60.)
                       + " | 1.1*x; y; 0.9*z\n set Weights = free\n set Weight penalty = paper\n")
            + "subsection Solver\n set Method = fixed point\n set Maximum iterations = 500\nend\n";
      Scene       cholesky(text, { "Solver/Linear solver=cholesky" });
      Scene       umfpack(text, { "Solver/Linear solver=umfpack" });
      const State a = cholesky.solve(), b = umfpack.solve();
      EXPECT_LT(max_difference(a.positions, b.positions), 1e-10);
      for (unsigned int i = 0; i < a.weights.size(); ++i)
        EXPECT_NEAR(a.weights[i], b.weights[i], 1e-10);
      EXPECT_NEAR(a.multipliers[0], b.multipliers[0], 1e-10 * std::abs(a.multipliers[0]));
    }
  } // namespace
} // namespace Exemplar::Testing
