// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/problem.h>

#include "body.h"
#include "matrices.h"
#include "scene.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    TEST(Equilibrium, PatchTest)
    {
      // an affine motion of the whole boundary is that of the inside
      const std::string all = "subsection Handles\n set Names = a, b, c, d, e, f\n";
      std::string       text
          = "set Scene = static\nsubsection Mesh\n set Generator = box\n set Box size = 2, 1, 1\n"
            "set Box cells = 3, 3, 3\nend\n"
            + all;
      for (unsigned int face = 1; face <= 6; ++face)
        text += std::string("subsection ") + "abcdef"[face - 1] + "\n set Select = boundary "
                + std::to_string(face)
                + "\n set Motion = t*(0.3*x+0.2*y); t*(0.1*x-0.2*y+0.1*z); t*(0.4*y+0.1*z)\nend\n";
      text += "end\nsubsection Time\n set Increments = 2\nend\n"
              "subsection Solver\n set Tolerance = 1e-13\nend\n";
      Scene       scene(text);
      const State state = scene.solve();
      const auto &rest  = scene.problem.fe_space.rest_positions();
      for (unsigned int node = 0; node < scene.problem.mesh.n_nodes(); ++node)
      {
        const double x = rest[3 * node], y = rest[3 * node + 1], z = rest[3 * node + 2];
        EXPECT_NEAR(state.positions[3 * node], x + 0.3 * x + 0.2 * y, 1e-12);
        EXPECT_NEAR(state.positions[3 * node + 1], y + 0.1 * x - 0.2 * y + 0.1 * z, 1e-12);
        EXPECT_NEAR(state.positions[3 * node + 2], z + 0.4 * y + 0.1 * z, 1e-12);
      }
    }

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

    TEST(Equilibrium, ImportanceZeroIsPlainElasticityBitForBit)
    {
      const std::string text = "set Scene = static\n" + bar + drag;
      Scene             without(text);
      Scene with(text + examples("set Pose functions = 2*x; y; z\n set Importance = 0\n"));
      EXPECT_EQ(max_difference(without.solve().positions, with.solve().positions), 0.);
      EXPECT_EQ(with.problem.examples, nullptr);
    }

    TEST(Equilibrium, FindsTheExampleThatItStartsFrom)
    {
      // at full importance and without penalty a pose is its own equilibrium
      const std::string pose = twist(90.);
      const std::string both = pose + " | 1.2*x; y; z";
      Scene             scene("set Scene = dynamic\n" + bar
                              + examples("set Pose functions = " + both
                                         + "\n set Importance = 1\n set Weight penalty = 0\n")
                              + "subsection Initial\n set Pose function = " + pose
                              + "\nend\nsubsection Time\n set Step = 0.1\n set End = 0.3\nend\n"
                                            "subsection Solver\n set Tolerance = 1e-12\nend\n");
      const State       state = scene.solve();
      EXPECT_NEAR(state.weights[0], 0., 1e-8);
      EXPECT_NEAR(state.weights[1], 1., 1e-8);
      EXPECT_NEAR(state.weights[2], 0., 1e-8);
      EXPECT_LT(max_difference(state.positions, scene.problem.examples->pose(1)), 1e-9);
    }

    TEST(Equilibrium, PermutedExamplesPermuteTheWeights)
    {
      const std::string text = "set Scene = static\n" + bar + drag;
      const std::string p = twist(60.), q = "1.2*x; 0.9*y; z";
      Scene             pq(text + examples("set Pose functions = " + p + " | " + q + "\n"));
      Scene             qp(text + examples("set Pose functions = " + q + " | " + p + "\n"));
      const State       a = pq.solve(), b = qp.solve();
      EXPECT_NEAR(a.weights[1], b.weights[2], 1e-9);
      EXPECT_NEAR(a.weights[2], b.weights[1], 1e-9);
      EXPECT_NEAR(a.weights[0], b.weights[0], 1e-9);
      EXPECT_GT(std::abs(a.weights[1] - a.weights[2]), 0.01); // else it proves nothing
      EXPECT_LT(max_difference(a.positions, b.positions), 1e-9);
    }

    TEST(Equilibrium, EveryExampleTwiceWithAPenaltyIsEachOnceWithHalfOfIt)
    {
      const std::string text = "set Scene = static\n" + bar + drag;
      const std::string p = twist(60.), q = "1.2*x; 0.9*y; z", rest = "x; y; z";
      Scene             once(
                      text + examples("set Pose functions = " + p + " | " + q + "\n set Weight penalty = 5\n"));
      Scene       twice(text
                        + examples("set Pose functions = " + p + " | " + q + " | " + rest + " | " + p
                                   + " | " + q + "\n set Weight penalty = 10\n"));
      const State a = once.solve(), b = twice.solve();
      EXPECT_LT(max_difference(a.positions, b.positions), 1e-9);
      for (unsigned int i = 0; i < 3; ++i)
        EXPECT_NEAR(a.weights[i], b.weights[i] + b.weights[i + 3], 1e-8);
    }

    TEST(Equilibrium, InterpolationEndsAtTheExamplesStrains)
    {
      for (const double degrees : { 90., 180. })
      {
        Scene scene("set Scene = interpolation\n" + bar
                    + examples("set Pose functions = " + twist(degrees)
                               + "\n set Prescribed weights = 1-t; t\n")
                    + "subsection Time\n set Increments = 6\nend\n"
                      "subsection Solver\n set Tolerance = 1e-12\nend\n");
        State state = scene.solve();
        align(scene.problem.examples->pose(1), state.positions);
        EXPECT_LT(max_difference(state.positions, scene.problem.examples->pose(1)), 1e-8 * 4.);
      }
    }

    TEST(Equilibrium, InterpolationEndsAtRest)
    {
      // from a twist whose middle is turned by 90 degrees back to where nothing acts
      Scene scene(
          "set Scene = interpolation\n" + bar
          + examples("set Pose functions = " + twist(180.) + "\n set Prescribed weights = t; 1-t\n")
          + "subsection Time\n set Increments = 10\nend\n");
      State state = scene.solve();
      align(scene.problem.fe_space.rest_positions(), state.positions);
      EXPECT_LT(max_difference(state.positions, scene.problem.fe_space.rest_positions()), 1e-7);
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

    TEST(Equilibrium, FreeFall)
    {
      // y_n = y_0 - g h^2 n (n + 1) / 2
      Scene       scene("set Scene = dynamic\n" + bar
                        + "subsection Loads\n set Gravity = 0, 0, -9.81\nend\n"
                                "subsection Time\n set Step = 0.1\n set End = 0.7\nend\n"
                                "subsection Solver\n set Tolerance = 1e-12\nend\n");
      const State state = scene.solve();
      for (unsigned int dof = 0; dof < state.positions.size(); ++dof)
        EXPECT_NEAR(state.positions[dof] - scene.problem.fe_space.rest_positions()[dof],
                    dof % 3 == 2 ? -9.81 * 0.01 * 7. * 8. / 2. : 0., 1e-12);
    }

    TEST(Equilibrium, UniaxialStretch)
    {
      // force E (s - 1) A and lateral stretch 1 - nu (s - 1), on rollers
      Scene scene(
          "set Scene = static\n" + bar
          + "subsection Material\n set Young's modulus = 1000\n set Poisson's ratio = 0.3\nend\n"
            "subsection Handles\n set Names = left, right, bottom, front\n"
            "subsection left\n set Select = boundary 1\n set Components = x\nend\n"
            "subsection right\n set Select = boundary 2\n set Components = x\n"
            "set Motion = 2*t; 0; 0\nend\n"
            "subsection bottom\n set Select = boundary 5\n set Components = z\nend\n"
            "subsection front\n set Select = boundary 3\n set Components = y\nend\nend\n"
            "subsection Solver\n set Tolerance = 1e-12\nend\n");
      const State state = scene.solve();
      const auto &p     = scene.problem;
      EXPECT_NEAR(p.handles->sum_over(1, p.evaluation.gradient)[0], 500., 1e-8);
      EXPECT_NEAR(p.handles->sum_over(0, p.evaluation.gradient)[0], -500., 1e-8);
      for (unsigned int node = 0; node < p.mesh.n_nodes(); ++node)
        EXPECT_NEAR(state.positions[3 * node + 2],
                    -0.5 + 0.85 * (p.mesh.get_nodes()[node][2] + 0.5), 1e-11);
    }

    TEST(Equilibrium, ImplicitEulerDampsAnOscillatorAsItShould)
    {
      // One free degree of freedom, the middle of a cube along x, with a small velocity:
      // x_n = Im (1 - i omega h)^(-n) v / omega with omega^2 = K / M.
      std::string text
          = "set Scene = dynamic\nsubsection Mesh\n set Generator = box\n set Box size = 2, 2, 2\n"
            "set Box cells = 2, 2, 2\nend\nsubsection Handles\n set Names = middle, a, b, c, d, e, "
            "f\n"
            "subsection middle\n set Select = sphere 1 0 0 0.1\n set Components = y, z\nend\n";
      for (unsigned int face = 1; face <= 6; ++face)
        text += std::string("subsection ") + "abcdef"[face - 1] + "\n set Select = boundary "
                + std::to_string(face) + "\nend\n";
      const double v = 1e-4, h = 0.01;
      Scene        scene(text
                         + "end\nsubsection Material\n set Young's modulus = 1e4\nend\nsubsection "
                                  "Initial\n set Velocity = abs(x-1) < 0.1 && abs(y) < 0.1 "
                                  "&& abs(z) < 0.1 ? 1e-4 : 0; 0; 0\nend\n"
                                  "subsection Time\n set Step = 0.01\n set End = 0.2\nend\n"
                                  "subsection Solver\n set Tolerance = 1e-8\nend\n");
      const auto  &p = scene.problem;
      ASSERT_EQ(p.free_dofs.size(), 1u);
      const unsigned int dof = p.free_dofs.list()[0];
      double             K = 0., M = 0.;
      for (unsigned int cell = 0; cell < p.fe_space.n_cells(); ++cell)
        for (int a = 0; a < 4; ++a)
          if (p.fe_space.nodes(cell)[a] == dof / 3)
          {
            const auto  &tet = p.fe_space.tetrahedron(cell);
            const auto  &g   = tet.shape_gradient[a];
            const double mu  = p.material.elasticity(cell).mu;
            K += tet.volume
                 * ((p.material.elasticity(cell).lambda + mu) * g[0] * g[0] + mu * dot(g, g));
            M += 1000. * tet.volume / 10.;
          }
      const double omega = std::sqrt(K / M);
      const double decay = 1. / std::sqrt(1. + omega * omega * h * h);
      const double expected
          = std::pow(decay, 20) * std::sin(20. * std::atan(omega * h)) * v / omega;
      const State state = scene.solve();
      EXPECT_NEAR(state.positions[dof] - 1., expected, 1e-4 * v / omega);
    }
  } // namespace
} // namespace Exemplar::Testing
