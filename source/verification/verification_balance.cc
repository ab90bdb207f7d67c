// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/output/diagnostics.h>
#include <exemplar/verification/verification.h>
#include <exemplar/verification/verification_scene.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

// Balance of energy in quasistatic scenes: the work of handles equals stored plus dissipated
// energy.

namespace Exemplar::Verification
{
  namespace
  {
    /// A bar with one end moved in this number of increments; `pull` are keys of its handle.
    std::string
    pulled_bar(const std::string &pull, const unsigned int increments)
    {
      return set("Scene", "static") + box({ { 4., 1., 1. } }, { { 4, 1, 1 } })
             + named_sections("Handles", { { "left", set("Select", "boundary 1") },
                                           { "right", set("Select", "boundary 2") + pull } })
             + section("Time", set("Increments", fmt::format("{}", increments)))
             + section("Solver", set("Tolerance", 1e-11));
    }

    /// Stored and dissipated energy [J].
    double
    kept_energy(const Diagnostics &diagnostics, const Problem &problem)
    {
      double sum = 0.;
      for (const StatisticsCell &cell : diagnostics.row(problem.state, {}))
        if (cell.column == "energy_elastic" || cell.column == "energy_example"
            || cell.column == "energy_dissipated")
          sum += std::get<double>(cell.value);
      return sum;
    }

    /// Work of the handles, by the trapezoidal rule, less stored and dissipated energy, relative to
    /// the greatest work up to an increment.
    double
    imbalance(const std::string &scene)
    {
      Scene             made(scene);
      Problem          &p = made.problem;
      const Diagnostics diagnostics(p);
      const double      at_start = kept_energy(diagnostics, p);
      double            work = 0., greatest = 0.;
      while (p.state.step < p.time_axis.n_steps())
      {
        const auto places = p.state.positions, forces = p.evaluation.gradient;
        if (const SolveReport report = p.advance(); !is_success(report.status))
          throw SolverFailure(
              fmt::format("step {}: {}", p.state.step + 1, status_name(report.status)));
        for (const unsigned int dof : p.constraints.handles.held_dofs())
          work += 0.5 * (forces[dof] + p.evaluation.gradient[dof])
                  * (p.state.positions[dof] - places[dof]);
        greatest = std::max(greatest, std::abs(work));
      }
      return std::abs(work - (kept_energy(diagnostics, p) - at_start)) / greatest;
    }

    std::vector<Measurement>
    balance(const std::string &pull, const std::string &more)
    {
      const auto error = [&](const unsigned int increments)
      { return imbalance(pulled_bar(pull, increments) + more); };
      const double coarse = error(50), fine = error(200);
      return { { "of 200 increments", 1e-3, fine, Comparison::at_most },
               { "order, from 50 to 200 increments", 0.9, std::log2(coarse / fine) / 2.,
                 Comparison::at_least } };
    }

    std::vector<Measurement>
    balance_of_elasticity()
    {
      return balance(set("Motion", "0.6*t; 0; 1.2*t"), "");
    }

    std::vector<Measurement>
    balance_of_memory()
    {
      return balance(set("Motion", "0; 0; 3*min(t,1-t)") + set("Components", "z"),
                     section("Examples", set("Pose functions", bend(60., 4.))
                                             + set("Energy", "blended") + set("Yield", "500")));
    }

    std::vector<Measurement>
    balance_of_plasticity()
    {
      return balance(set("Motion", "0.6*min(t,1-t); 0; 1.2*min(t,1-t)"),
                     section("Material", set("Young's modulus", 1e6) + set("Yield stress", 2e4)
                                             + set("Kinematic hardening", 5e4)
                                             + set("Isotropic hardening", 3e4)));
    }
  } // namespace

  std::vector<Case>
  balance_cases()
  {
    const std::string what
        = "work of handles, with mean forces, less stored and dissipated energy, "
          "over the work; ";
    return {
      { "balance-of-elasticity", what + "a bar pulled and bent", balance_of_elasticity },
      { "balance-of-memory", what + "a bar with examples and Yield, bent and brought back",
        balance_of_memory },
      { "balance-of-plasticity", what + "a bar that yields, bent and brought back",
        balance_of_plasticity },
    };
  }
} // namespace Exemplar::Verification
