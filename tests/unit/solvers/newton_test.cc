// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/problem/problem.h>

#include "body.h"
#include "matrices.h"
#include "scene.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    const std::string newton = "subsection Model\n set Gradient = consistent\nend\n"
                               "subsection Solver\n set Method = newton\n set Tolerance = 1e-11\n"
                               "set Maximum iterations = 50\nend\n";

    TEST(Newton, WithoutExamplesItFindsWhatTheFixedPointFinds)
    {
      const std::string text = "set Scene = static\n" + bar + drag;
      Scene             fixed_point(text
                                    + "subsection Solver\n set Method = fixed point\n set Tolerance = "
                                                  "1e-11\nend\n");
      Scene             by_newton(text + newton);
      EXPECT_LT(max_difference(fixed_point.solve().positions, by_newton.solve().positions), 1e-9);
    }

    TEST(Newton, ABodyIsAtRestWhereItsForcesAreHeldBack)
    {
      Scene                 scene("set Scene = static\n" + bar + drag
                                  + "subsection Loads\n set Gravity = 0, 0, -9.81\nend\n" + newton);
      IncrementalPotential &potential = scene.problem.potential;
      State                 state     = scene.problem.state;
      Evaluation            free, held;
      potential.set_time(0., state);
      potential.evaluate(state, RotationUse::update, free);
      ASSERT_GT(potential.get_free_dofs().max_magnitude(free.gradient), 1.);
      potential.get_held_back().hold(potential.get_free_dofs(), free.gradient, state.positions);
      potential.evaluate(state, RotationUse::update, held);
      EXPECT_EQ(potential.get_free_dofs().max_magnitude(held.gradient), 0.);
      EXPECT_EQ(held.potential, free.potential);
      // the gradient is that of the potential, elsewhere and with a part let go
      potential.get_held_back().set_part(0.25);
      const unsigned int dof    = potential.get_free_dofs().list().back();
      double             change = 0.;
      for (const double side : { 1., -1. })
      {
        State beside = state;
        beside.positions[dof] += side * 1e-5;
        potential.evaluate(beside, RotationUse::update, held);
        change += side * held.potential;
      }
      potential.evaluate(state, RotationUse::update, held);
      EXPECT_NEAR(change / 2e-5, held.gradient[dof], 1e-5 * std::abs(held.gradient[dof]));
      EXPECT_NEAR(held.gradient[dof], 0.75 * free.gradient[dof],
                  1e-9 * std::abs(free.gradient[dof]));
      potential.get_held_back().let_go();
      potential.evaluate(state, RotationUse::update, held);
      EXPECT_EQ(potential.get_free_dofs().max_magnitude(held.gradient),
                potential.get_free_dofs().max_magnitude(free.gradient));
    }

    TEST(Newton, ConvergesQuadratically)
    {
      Scene scene("set Scene = static\n" + bar + drag + examples(two_poses + "set Weights = free\n")
                  + newton + "subsection Time\n set Increments = 1\nend\n");
      const SolveReport report = scene.problem.advance();
      ASSERT_EQ(report.status, SolveStatus::converged);
      // once small, the residual's exponent doubles: r_(k+1) <= C r_k^2. A linear rate of
      // 0.3, the fixed point's, would fail this from 1e-4 on
      const auto  &r       = report.residual_history;
      unsigned int telling = 0; // iterations that a linear rate of 0.1 would fail
      for (unsigned int k = 0; k + 1 < r.size(); ++k)
        if (r[k] < 1e-2)
        {
          const double bound = std::max(500. * r[k] * r[k], 1e-11);
          EXPECT_LT(r[k + 1], bound);
          telling += bound < 0.1 * r[k];
        }
      EXPECT_GE(telling, 1u);
    }

    TEST(Newton, InterpolatesATwistOf720Degrees)
    {
      Scene scene("set Scene = interpolation\nsubsection Mesh\n set Generator = box\n"
                  "set Box size = 4, 1, 1\n set Box cells = 8, 2, 2\nend\n"
                      + examples("set Pose functions = " + twist(720.)
                                 + "\n set Prescribed weights = 1-t; t\n")
                      + newton + "subsection Time\n set Increments = 20\nend\n",
                  { "Model/Dilatation=cells" }); // patches end beside it, doc/choosing.md
      State state = scene.solve();
      align(scene.problem.examples.poses.pose(1), state.positions, Exchange::serial());
      EXPECT_LT(max_difference(state.positions, scene.problem.examples.poses.pose(1)), 1e-9);
    }

    TEST(Newton, InterpolatesFromABodyCollapsedToALine)
    {
      for (const std::string start : { "x; 0; 0", "0; 0; 0" })
      {
        Scene scene(
            "set Scene = interpolation\n" + bar
            + examples("set Pose functions = 1.1*x; y; z\n set Prescribed weights = 1-t; t\n")
            + "subsection Initial\n set Pose function = " + start
            + "\nend\nsubsection Time\n set Increments = 1\nend\n");
        EXPECT_EQ(scene.problem.advance().status, SolveStatus::converged) << start;
      }
    }

    TEST(Newton, SimplexWeightsAreNeverNegative)
    {
      Scene scene("set Scene = static\n" + bar + drag
                  + examples(two_poses + "set Weights = simplex\n") + newton);
      Scene free("set Scene = static\n" + bar + drag + examples(two_poses + "set Weights = free\n")
                 + newton);
      const State state = scene.solve(), unbounded = free.solve();
      double      sum = 0., least_free = 0.;
      for (unsigned int i = 0; i < 3; ++i)
      {
        EXPECT_GE(state.weights[i], 0.);
        sum += state.weights[i];
        least_free = std::min(least_free, unbounded.weights[i]);
      }
      EXPECT_NEAR(sum, 1., 1e-14);
      EXPECT_LT(least_free, -1e-3); // else the bound proves nothing
    }

    TEST(Newton, BlendedEnergyHoldsTheWeightsBack)
    {
      // scaled, eta w is the same for every eta (`exemplar verify free-weights-undo-importance`)
      const auto eta_w = [&](const std::string &eta, const std::string &energy)
      {
        Scene scene("set Scene = static\n" + bar + drag
                    + examples("set Pose functions = " + twist(60.) + "\n set Weights = free\n"
                               + "set Weight penalty = 0\n set Importance = " + eta
                               + "\n set Energy = " + energy + "\n")
                    + newton);
        return std::stod(eta) * scene.solve().weights[1];
      };
      EXPECT_NEAR(eta_w("1", "blended") / eta_w("1", "scaled"), 1., 1e-6);
      EXPECT_LT(eta_w("0.5", "blended") / eta_w("1", "scaled"), 0.8);
    }

    TEST(Newton, RecoversFromABodyCrushedIntoAPlane)
    {
      Scene       scene("set Scene = static\n" + bar + "subsection Handles\n set Names = left\n"
                        + held_left + "end\nsubsection Initial\n set Pose function = x; y; 0\nend\n"
                        + newton);
      const State state = scene.solve();
      EXPECT_LT(max_difference(state.positions, scene.problem.body.fe_space.rest_positions()),
                1e-8);
    }

    TEST(Newton, TheDefaultPenaltyLeavesAnUnloadedBodyAtRest)
    {
      Scene       scene("set Scene = static\n" + bar + examples(two_poses)
                            + "subsection Handles\n set Names = left\n" + held_left + "end\n" + newton,
                        // in one patch, so coarse a bar is too soft to weigh the penalty against
                        { "Model/Dilatation=cells" });
      const State state = scene.solve();
      EXPECT_LT(max_difference(state.positions, scene.problem.body.fe_space.rest_positions()),
                1e-6 * 4.);
      EXPECT_GT(state.weights[0], 1. - 1e-4);
    }

    TEST(Newton, TheDefaultPenaltyDecidesTies)
    {
      Scene       scene("set Scene = static\n" + bar + drag
                        + examples("set Pose functions = " + twist(60.) + " | " + twist(60.) + "\n")
                        + newton);
      const State state = scene.solve();
      EXPECT_NEAR(state.weights[1], state.weights[2], 1e-6);
      EXPECT_GT(state.weights[1], 1e-3);
    }

    TEST(Newton, NeedsAnEnergy)
    {
      EXPECT_THROW(Scene("set Scene = static\n" + bar + drag
                         + "subsection Solver\n set Method = newton\nend\n"
                           "subsection Model\n set Gradient = frozen\nend\n"),
                   UserError);
    }
  } // namespace
} // namespace Exemplar::Testing
