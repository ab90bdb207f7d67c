// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/problem/problem.h>

#include "body.h"
#include "scene.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    TEST(Equilibrium, CholeskyAndUmfpackAgree)
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

    TEST(Equilibrium, InterpolationEndsAtRest)
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

    TEST(Equilibrium, AnOverflowIsAFailureAndNoSolution)
    {
      Scene scene(
          "set Scene = static\n" + bar + "subsection Handles\n set Names = left, right\n"
          + held_left
          + "subsection right\n set Select = boundary 2\n set Motion = 1e160*t; 0; 0\nend\nend\n");
      const SolveReport report = scene.problem.advance();
      EXPECT_EQ(report.status, SolveStatus::failed);
      EXPECT_EQ(scene.problem.state.step, 0u);
    }
  } // namespace
} // namespace Exemplar::Testing
