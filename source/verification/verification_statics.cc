// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/verification/verification.h>
#include <exemplar/verification/verification_scene.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

// Patch test, Newton's method, and interpolation between poses.

namespace Exemplar::Verification
{
  namespace
  {
    /// A box of 2 x 1 x 1 whose interior nodes are perturbed by up to 0.1.
    Inputs
    irregular_box()
    {
      std::mt19937                           generator(1);
      std::uniform_real_distribution<double> uniform(-0.1, 0.1);
      const auto                             is_inside = [](const dealii::Point<3> &p)
      {
        return p[0] > 1e-9 && p[0] < 2. - 1e-9 && std::abs(p[1]) < 0.5 - 1e-9
               && std::abs(p[2]) < 0.5 - 1e-9;
      };
      return moved_box({ { 2., 1., 1. } }, { { 4, 3, 3 } },
                       [&](const dealii::Point<3> &p)
                       {
                         dealii::Point<3> moved = p;
                         if (is_inside(p))
                           for (unsigned int c = 0; c < 3; ++c)
                             moved[c] += uniform(generator);
                         return moved;
                       });
    }

    std::vector<Measurement>
    patch()
    {
      const Matrix3<double> F      = { { { 1.3, 0.2, 0. }, { 0.1, 0.8, 0.1 }, { 0., 0.4, 1.1 } } };
      const std::string     motion = "t*(0.3*x+0.2*y); t*(0.1*x-0.2*y+0.1*z); t*(0.4*y+0.1*z)";
      std::vector<std::pair<std::string, std::string>> faces;
      for (unsigned int face = 1; face <= 6; ++face)
        faces.emplace_back(fmt::format("face {}", face),
                           set("Select", fmt::format("boundary {}", face)) + set("Motion", motion));
      Scene       scene(set("Scene", "static") + named_sections("Handles", faces)
                            + section("Time", set("Increments", "2"))
                            + section("Solver", set("Tolerance", 1e-13)),
                        {}, irregular_box());
      const State state = scene.solve();
      const auto  field = moved_rigidly(scene.problem.body.fe_space.rest_positions(), F, {});
      return { { "inside less affine field", 0., max_difference(state.positions, field),
                 Comparison::absolute, 1e-12 } };
    }

    /// One step of Newton's method with the exact tangent, prescribed weights and no loads.
    void
    newton_step(Problem &p, dealii::Vector<double> &x, const std::vector<double> &weights)
    {
      const ElasticEvaluation at = evaluate(p, x, weights);
      p.system.factorize(x, weights, 0.);
      BorderedVector unknowns;
      for (const unsigned int dof : p.constraints.free_dofs.list())
        unknowns.positions.push_back(-at.gradient[dof]);
      p.system.bordered().solve(unknowns, {});
      for (unsigned int i = 0; i < p.constraints.free_dofs.size(); ++i)
        x[p.constraints.free_dofs.list()[i]] += unknowns.positions[i];
    }

    /// Quadratic convergence: half the error leads to a quarter of the error after a step.
    std::vector<Measurement>
    newton_quadratic()
    {
      Scene scene(
          set("Scene", "static") + box({ { 4., 1., 1. } }, { { 4, 1, 1 } })
          + named_sections("Handles", { { "left", set("Select", "boundary 1") },
                                        { "right", set("Select", "boundary 2")
                                                       + set("Motion", "0.2*t; 0.6*t; 0.3*t") } })
          + section("Examples", set("Pose functions", twist(60., 4.)) + set("Weights", "prescribed")
                                    + set("Prescribed weights", "1-t; t")));
      Problem                         &p        = scene.problem;
      const State                      solution = scene.solve();
      std::mt19937                     generator(2);
      std::normal_distribution<double> normal;
      dealii::Vector<double>           direction(solution.positions.size());
      for (const unsigned int dof : p.constraints.free_dofs.list())
        direction[dof] = normal(generator);
      auto exact = solution.positions;
      newton_step(p, exact, solution.weights); // exact to rounding
      const auto error_left = [&](const double error)
      {
        auto x = exact;
        x.add(error, direction);
        newton_step(p, x, solution.weights);
        return max_difference(x, exact);
      };
      return { { "order of a step", 2., std::log2(error_left(1e-3) / error_left(5e-4)),
                 Comparison::absolute, 0.1 } };
    }

    /// max |S - I - E_1| over the cells.
    double
    strain_error(const Problem &p, const State &state)
    {
      double maximum = 0.;
      for (unsigned int cell = 0; cell < p.body.mesh.n_cells(); ++cell)
      {
        const Matrix3<double> F     = p.body.fe_space.deformation_gradient(cell, state.positions);
        const Matrix3<double> error = combine(1., corotated_strain(closest_rotation(F), F), -1.,
                                              p.examples.poses.strain(cell, 1));
        maximum                     = max_or_nan(maximum, std::sqrt(contract(error, error)));
      }
      return maximum;
    }

    /// Weights and body must move evenly from pose to pose: if the body jumps to another
    /// equilibrium, one increment is much longer than the others.
    std::vector<Measurement>
    interpolation(const std::string &pose,
                  const unsigned int increments,
                  const std::string &dilatation = "auto")
    {
      Scene scene(
          set("Scene", "interpolation") + box({ { 4., 1., 1. } }, { { 16, 4, 4 } })
          + section("Model", set("Dilatation", dilatation))
          + section("Examples", set("Pose functions", pose) + set("Prescribed weights", "1-t; t"))
          + section("Time", set("Increments", fmt::format("{}", increments)))
          + section("Solver", set("Tolerance", 1e-13)));
      Problem            &p = scene.problem;
      std::vector<double> ways; // of the node that moves most, by increment
      for (unsigned int step = 0; step < increments; ++step)
      {
        const dealii::Vector<double> before = p.state.positions;
        const SolveReport            report = p.advance();
        if (!is_success(report.status))
          throw SolverFailure(
              fmt::format("increment {}: {}", step + 1, status_name(report.status)));
        ways.push_back(max_difference(before, p.state.positions));
      }
      const double           longest = *std::max_element(ways.begin(), ways.end());
      const double           mean    = std::accumulate(ways.begin(), ways.end(), 0.) / increments;
      dealii::Vector<double> aligned = p.state.positions;
      align(p.examples.poses.pose(1), aligned, p.body.exchange());
      return { { "|S - I - E|", 1e-12, strain_error(p, p.state), Comparison::at_most },
               { "distance to the pose", 0., max_difference(aligned, p.examples.poses.pose(1)) / 4.,
                 Comparison::absolute, 1e-8 },
               { "longest increment, of the mean", 2., longest / mean, Comparison::at_most } };
    }
  } // namespace

  std::vector<Case>
  static_cases()
  {
    return { { "patch", "affine boundary data give the affine field; doc/model.md, closed forms",
               patch },
             { "newton-quadratic", "what a step with the tangent (18) leaves of a small error",
               newton_quadratic },
             { "interpolation-twist-360", "16x4x4 bar, 10 increments: reaches the pose's strains",
               [] { return interpolation(twist(360., 4.), 10); } },
             { "interpolation-twist-720",
               "16x4x4 bar, 20 increments, dilatation of each cell: reaches the pose's strains",
               [] { return interpolation(twist(720., 4.), 20, "cells"); } },
             { "interpolation-bend-180", "16x4x4 bar, 10 increments: reaches the pose's strains",
               [] { return interpolation(bend(180., 4.), 10); } } };
  }
} // namespace Exemplar::Verification
