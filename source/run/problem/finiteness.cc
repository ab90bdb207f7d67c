// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/run/problem/finiteness.h>

#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// Whether all numbers of an array are finite, and their squares, of which energies consist.
    template <typename Numbers>
    bool
    are_finite(const Numbers &numbers)
    {
      return max_entry(numbers.begin(), numbers.end()) < 1e150;
    }
  } // namespace

  std::string
  what_is_not_finite(const State &state, const Evaluation &evaluation)
  {
    if (!are_finite(state.positions))
      return "positions";
    if (!are_finite(state.velocities))
      return "velocities";
    if (!are_finite(state.weights) || !are_finite(state.multipliers))
      return "weights";
    const ElasticEvaluation &elastic = evaluation.elastic;
    if (!std::isfinite(elastic.energy) || !std::isfinite(elastic.energy_elastic)
        || !std::isfinite(evaluation.potential))
      return "energies";
    if (!std::isfinite(elastic.min_det_F))
      return "ratios of volumes";
    return "";
  }

  std::string
  what_is_not_finite(const CellResults &cells)
  {
    const auto some_are_not
        = [](const std::vector<double> &numbers) { return !std::isfinite(max_entry(numbers)); };
    if (some_are_not(cells.strain_energy_density))
      return "densities of energy";
    if (some_are_not(cells.det_F))
      return "ratios of volumes";
    if (some_are_not(cells.von_mises_stress))
      return "stresses";
    if (some_are_not(cells.plastic_strain))
      return "plastic strains";
    return "";
  }

  std::string
  what_is_not_finite(const Frame &frame)
  {
    const auto are_finite_values
        = [](const Vector &x) { return std::isfinite(max_entry(x.begin(), x.end())); };
    if (!are_finite_values(frame.positions))
      return "positions";
    if (!are_finite_values(frame.velocities))
      return "velocities";
    for (const NodalField &field : frame.fields)
      if (!are_finite_values(field.values))
        return "values of " + field.name;
    return what_is_not_finite(frame.cells);
  }

  void
  check_start(Problem &problem)
  {
    const State          &state      = problem.state;
    const Evaluation     &evaluation = problem.evaluation;
    IncrementalPotential &potential  = problem.potential;
    const Exchange       &exchange   = problem.body.exchange();
    const CellResults     cells = problem.elastic->cell_results(state.positions, state.weights);
    std::string           what  = exchange.first_text(what_is_not_finite(state, evaluation));
    if (what.empty())
      what = exchange.first_text(what_is_not_finite(cells));
    if (what.empty() && problem.actions.mass != nullptr
        && !std::isfinite(problem.actions.mass->motion_sums(state).kinetic_energy))
      what = "kinetic energies";
    try
    {
      potential.residual(state, evaluation);
    }
    catch (const SolverFailure &)
    {
      what = "forces"; // or their scales
    }
    if (!what.empty())
      throw UserError(
          problem.parameters.name + ": the " + what
          + " of the initial state are not finite numbers, or too large to compute with. "
            "Mesh/Scale, Material, Loads or Initial are too large or too small by many powers of "
            "ten: look at their units.");
  }

  void
  refuse_what_is_not_finite(Problem &problem, const State &next, SolveReport &report)
  {
    const Body     &body     = problem.body;
    const Exchange &exchange = body.exchange();
    std::string     what     = exchange.first_text(std::isfinite(report.residual)
                                                       ? what_is_not_finite(next, problem.evaluation)
                                                       : "residuals");
    // frames hold cubes of such ratios, which may overflow where energies, their squares, do not
    const auto maximum
        = [&](const Vector &x) { return exchange.max(max_entry(x.begin(), x.end())); };
    if (what.empty() && !(maximum(next.positions) < 1e60 * maximum(body.fe_space.rest_positions())))
      what = exchange.first_text(
          what_is_not_finite(problem.elastic->cell_results(next.positions, next.weights)));
    if (what.empty())
      return;
    report.status  = SolveStatus::failed;
    report.failure = "its " + what
                     + " are not finite numbers, or too large to compute with. Take smaller steps, "
                       "and look at what handles, loads and Initial do.";
  }
} // namespace Exemplar
