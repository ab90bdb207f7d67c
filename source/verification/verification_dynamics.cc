// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/verification/verification.h>
#include <exemplar/verification/verification_scene.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

// Implicit Euler: exact sequences, conservation laws, order.

namespace Exemplar::Verification
{
  namespace
  {
    const std::string falling_bar
        = set("Scene", "dynamic") + box({ { 4., 1., 1. } }, { { 4, 1, 1 } });

    const std::string held_left
        = named_sections("Handles", { { "left", set("Select", "boundary 1") } });

    const std::string frozen_gradient = section("Model", set("Gradient", "frozen"));

    std::string
    time(const double step, const double end)
    {
      return section("Time", set("Step", step) + set("End", end));
    }

    std::string
    examples_with(const std::string &weights)
    {
      return section("Examples", set("Pose functions", twist(60., 4.) + " | 1.2*x; 0.9*y; z")
                                     + set("Weights", weights));
    }

    void
    advance(Problem &problem)
    {
      const SolveReport report = problem.advance();
      if (!is_success(report.status))
        throw SolverFailure(
            fmt::format("step {}: {}", problem.state.step + 1, status_name(report.status)));
    }

    std::vector<Measurement>
    free_fall()
    {
      const double g = 9.81, h = 0.1, n = 7.;
      const double drop = -g * h * h * n * (n + 1.) / 2.;
      Scene scene(falling_bar + section("Loads", set("Gravity", "0, 0, -9.81")) + time(h, n * h)
                  + section("Solver", set("Tolerance", 1e-12) + set("Step tolerance", 0.)));
      dealii::Vector<double> error = scene.solve().positions;
      error -= scene.problem.body.fe_space.rest_positions();
      const double fallen = error[2];
      for (unsigned int dof = 2; dof < error.size(); dof += 3)
        error[dof] -= drop;
      return { { "y_n - y_0 of a node", drop, fallen, Comparison::absolute, 1e-12 },
               { "greatest error of a node", 0., max_entry(error.begin(), error.end()),
                 Comparison::absolute, 1e-12 } };
    }

    /// A cube of 2^3 bricks whose single free degree of freedom, its centre along x, has the
    /// initial velocity v.
    std::string
    oscillator(const double v, const double h, const unsigned int n)
    {
      const auto held = [](const std::string &selection) { return set("Select", selection); };
      std::vector<std::pair<std::string, std::string>> handles
          = { { "middle", held("sphere 1 0 0 0.1") + set("Components", "y, z") } };
      for (unsigned int face = 1; face <= 6; ++face)
        handles.emplace_back(fmt::format("face {}", face), held(fmt::format("boundary {}", face)));
      const std::string at_middle
          = "abs(x-1) + abs(y) + abs(z) < 0.1 ? " + shortest_text(v) + " : 0";
      return set("Scene", "dynamic") + box({ { 2., 2., 2. } }, { { 2, 2, 2 } })
             + section("Material", set("Young's modulus", 1e4))
             + section("Model", set("Dilatation", "cells")) // as in oscillator_frequency()
             + named_sections("Handles", handles)
             + section("Initial", set("Velocity", at_middle + "; 0; 0")) + time(h, n * h);
    }

    /// omega of the free degree of freedom at rest, from shape gradients and masses.
    double
    oscillator_frequency(const Problem &p)
    {
      const unsigned int node = p.constraints.free_dofs.list()[0] / 3;
      double             K = 0., M = 0.;
      for (unsigned int cell = 0; cell < p.body.mesh.n_cells(); ++cell)
        for (unsigned int a = 0; a < 4; ++a)
          if (p.body.fe_space.nodes(cell)[a] == node)
          {
            const auto  &C      = p.body.material.elasticity(cell);
            const auto  &g      = p.body.fe_space.gradients(cell)[a];
            const double volume = p.body.fe_space.volume(cell);
            K += volume * ((C.lambda + C.mu) * g[0] * g[0] + C.mu * dot(g, g));
            M += p.body.material.density(cell) * volume / 10.;
          }
      return std::sqrt(K / M);
    }

    std::vector<Measurement>
    implicit_euler_oscillator()
    {
      // the material is linear only in the limit: at a displacement v / omega of 1e-5 cells, the
      // quadratic term is 1e-5 of the linear one
      const double        v = 1e-4, h = 0.01;
      const unsigned int  n = 20;
      Scene               scene(oscillator(v, h, n));
      Problem            &p     = scene.problem;
      const double        omega = oscillator_frequency(p);
      const unsigned int  dof   = p.constraints.free_dofs.list()[0];
      const auto          x     = [&] { return p.state.positions[dof] - 1.; };
      std::vector<double> path  = { x() };
      for (unsigned int step = 0; step < n; ++step)
      {
        advance(p);
        path.push_back(x());
      }
      // x_n = v/omega Im z^n satisfies x_(n+1) = 2 Re(z) x_n - |z|^2 x_(n-1): two such equations
      const double *c          = &path[n / 2];
      const double  D          = c[0] * c[0] - c[-1] * c[1];
      const double  twice_real = (c[0] * c[1] - c[-1] * c[2]) / D;
      const double  square     = (c[1] * c[1] - c[0] * c[2]) / D;
      const double  decay      = 1. / std::sqrt(1. + omega * omega * h * h);
      const double  expected = std::pow(decay, n) * std::sin(n * std::atan(omega * h)) * v / omega;
      return { { "amplitude a step", decay, std::sqrt(square), Comparison::relative, 1e-4 },
               { "phase a step", std::atan(omega * h),
                 std::acos(0.5 * twice_real / std::sqrt(square)), Comparison::relative, 1e-4 },
               { "x_20 omega / v", expected * omega / v, path[n] * omega / v, Comparison::absolute,
                 1e-4 } };
    }

    /// Order of the scheme from the differences between step lengths h, h/2, h/4.
    std::vector<Measurement>
    order_in_time(const std::string &scheme, const double expected)
    {
      std::array<dealii::Vector<double>, 3> ends;
      for (unsigned int halvings = 0; halvings < 3; ++halvings)
        ends[halvings]
            = Scene(falling_bar + held_left
                    + section("Material", set("Young's modulus", 1e5) + set("Poisson's ratio", 0.3))
                    + section("Initial", set("Velocity", "0; 0.2*x*x; -0.1*x*x"))
                    + time(0.002 / (1u << halvings), 0.1) + section("Time", set("Scheme", scheme)))
                  .solve()
                  .positions;
      const double coarse = max_difference(ends[0], ends[1]),
                   fine   = max_difference(ends[1], ends[2]);
      return { { "order", expected, std::log2(coarse / fine), Comparison::absolute, 0.1 } };
    }

    /// Mass damping of a free body in uniform motion.
    std::vector<Measurement>
    mass_damping()
    {
      const double h = 0.01, alpha = 5.;
      Scene        scene(falling_bar + section("Initial", set("Velocity", "1; 0; 0")) + time(h, 0.2)
                         + section("Time", set("Mass damping", alpha)));
      const State  state = scene.solve();
      return { { "velocity", std::pow(1. + alpha * h, -20.), state.velocities[0],
                 Comparison::relative, 1e-10 } };
    }

    dealii::Tensor<1, 3>
    tensor(const Vector3<double> &a)
    {
      return dealii::Tensor<1, 3>({ a[0], a[1], a[2] });
    }

    /// Greatest relative defect of L_(n+1) = L_n + h sum v_(n+1) x M v_n of a free body.
    double
    angular_momentum_defect(const std::string &model_and_solver)
    {
      const double h = 0.02;
      Scene        scene(falling_bar + examples_with("free")
                         + section("Initial", set("Pose function", "1.1*x; y+0.05*x*x; z+0.1*y")
                                                  + set("Velocity", "-3*y; 3*x; x"))
                         + time(h, 0.2) + model_and_solver);
      Problem     &p       = scene.problem;
      double       maximum = 0.;
      while (p.state.step < p.time_axis.n_steps())
      {
        const State before = p.state;
        advance(p);
        const auto gain
            = tensor(torque(p.state.velocities, mass_times(*p.actions.mass, before.velocities)));
        const auto law = p.actions.mass->motion_sums(before).angular_momentum + h * gain;
        const auto now = p.actions.mass->motion_sums(p.state).angular_momentum;
        maximum        = max_or_nan(maximum, (now - law).norm() / now.norm());
      }
      return maximum;
    }

    std::vector<Measurement>
    angular_momentum()
    {
      return { { "defect of the law", 0.,
                 angular_momentum_defect(
                     section("Solver", set("Method", "newton") + set("Tolerance", 1e-12))),
                 Comparison::absolute, 1e-10 } };
    }

    std::vector<Measurement>
    angular_momentum_frozen()
    {
      return { { "defect of the law", 1e-5,
                 angular_momentum_defect(frozen_gradient
                                         + section("Solver", set("Method", "fixed point")
                                                                 + set("Maximum iterations", "500")
                                                                 + set("Tolerance", 1e-11))),
                 Comparison::at_least } };
    }

    std::vector<Measurement>
    energy_bound()
    {
      Scene    scene(falling_bar + held_left + examples_with("simplex")
                     + section("Initial", set("Velocity", "0; 2*x; -x")) + time(0.05, 1.));
      Problem &p       = scene.problem;
      double   maximum = -1.;
      while (p.state.step < p.time_axis.n_steps())
      {
        const State  before = p.state;
        const double bound
            = p.evaluation.elastic.energy + p.actions.mass->motion_sums(before).kinetic_energy;
        advance(p);
        State change = p.state;
        change.velocities -= before.velocities;
        const double left
            = p.evaluation.elastic.energy + p.actions.mass->motion_sums(change).kinetic_energy;
        maximum = max_or_nan(maximum, left / bound - 1.);
      }
      return { { "greatest excess", 1e-12, maximum, Comparison::at_most } };
    }
  } // namespace

  std::vector<Case>
  dynamic_cases()
  {
    return {
      { "free-fall", "y_n = y_0 - g h^2 n (n+1) / 2; doc/model.md, closed forms", free_fall },
      { "implicit-euler-oscillator",
        "amplitude (1+w^2 h^2)^(-1/2) and phase atan(w h) a step; doc/model.md, closed forms",
        implicit_euler_oscillator },
      { "implicit-euler-order", "first order in the step; self-convergence",
        [] { return order_in_time("implicit euler", 1.); } },
      { "bdf2-order", "second order in the step; self-convergence",
        [] { return order_in_time("bdf2", 2.); } },
      { "mass-damping", "v_n = v_0 (1 + a h)^(-n) of a body in uniform motion", mass_damping },
      { "angular-momentum", "free body: L_(n+1) = L_n + h sum v_(n+1) x M v_n, Eqs. (12), (17)",
        angular_momentum },
      { "angular-momentum-frozen", "that the frozen force breaks this law",
        angular_momentum_frozen },
      { "energy-bound",
        "Psi_(n+1) + |v_(n+1) - v_n|^2_M/2 <= Psi_n + |v_n|^2_M/2 at rest of the handles",
        energy_bound }
    };
  }
} // namespace Exemplar::Verification
