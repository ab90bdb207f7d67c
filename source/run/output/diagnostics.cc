// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/run/output/diagnostics.h>
#include <exemplar/run/output/weight_names.h>

#include <fmt/core.h>

#include <numeric>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    void
    append(StatisticsRow &row, const std::string &column, const double value)
    {
      row.push_back({ column, value });
    }

    void
    append(StatisticsRow &row, const std::string &column, const dealii::Tensor<1, 3> &value)
    {
      for (unsigned int c = 0; c < 3; ++c)
        append(row, column + "_" + "xyz"[c], value[c]);
    }
  } // namespace

  std::string
  StatisticsCell::text() const
  {
    if (const double *const number = std::get_if<double>(&value))
      return shortest_text(*number);
    if (const unsigned int *const number = std::get_if<unsigned int>(&value))
      return fmt::format("{}", *number);
    const std::string *const word = std::get_if<std::string>(&value);
    return word == nullptr ? "" : *word;
  }

  Diagnostics::Diagnostics(const Problem &problem, const Columns wanted)
      : problem(problem), last_positions(problem.state.positions)
  {
    if (wanted == Columns::of_beginning)
      for (const StatisticsCell &cell : present_row(problem.state, SolveReport()))
        columns.push_back(cell.column);
  }

  StatisticsRow
  Diagnostics::row(const State &shown, const SolveReport &report) const
  {
    StatisticsRow present = present_row(shown, report);
    if (columns.empty())
      return present;
    StatisticsRow row;
    for (const std::string &column : columns)
    {
      const auto cell = std::find_if(present.begin(), present.end(),
                                     [&](const StatisticsCell &candidate)
                                     { return candidate.column == column; });
      row.push_back(cell == present.end() ? StatisticsCell{ column } : *cell);
    }
    return row;
  }

  void
  Diagnostics::resume(const Work &earlier)
  {
    work           = earlier;
    last_positions = problem.state.positions;
  }

  void
  Diagnostics::add_step()
  {
    const State   &state   = problem.state;
    const Handles &handles = problem.constraints.handles;
    const Loads   *loads   = problem.actions.loads.get();
    displacement           = state.positions;
    displacement -= last_positions;
    const Exchange &exchange = problem.body.exchange();
    if (handles.size() > 0)
    {
      if (const unsigned int version = problem.constraints.free_dofs.version();
          version != held_version)
      {
        held         = handles.held_dofs();
        held_version = version;
      }
      double own = 0.;
      at_root(exchange, [&] { own = work.handles; });
      for (const unsigned int dof : held)
        if (exchange.owns(dof / 3))
          own += problem.evaluation.gradient[dof] * displacement[dof];
      work.handles = exchange.sum(own);
    }
    if (loads != nullptr && loads->has_gravity())
      work.gravity
          += loads->ramp_factor(state.time) * exchange.product(loads->gravity(), displacement);
    if (loads != nullptr && loads->has_named_loads())
    {
      Vector force(displacement.size());
      loads->named_loads(state.time, force);
      work.loads += exchange.product(force, displacement);
    }
    last_positions = state.positions;
  }

  StatisticsRow
  Diagnostics::present_row(const State &shown, const SolveReport &report) const
  {
    const ElasticEvaluation &elastic          = problem.evaluation.elastic;
    const Mass              *mass             = problem.actions.mass.get();
    const bool               is_with_examples = problem.examples.poses.size() > 0;
    const MotionSums         sums = mass != nullptr ? mass->motion_sums(shown) : MotionSums();
    StatisticsRow            row  = { { "step", shown.step, true },
                                      { "time", shown.time, true },
                                      { "status", status_name(report.status), true },
                                      { "iterations", report.iterations, true },
                                      { "residual", report.residual, true } };
    if (report.status == SolveStatus::failed)
      row.back().value = std::monostate();
    row.push_back({ "factorizations", report.factorizations, true });
    if (const Method method = problem.parameters.solver.method;
        method == Method::newton || method == Method::quasi_newton)
      append(row, "newton_decrement", report.newton_decrement);
    append(row, "energy_elastic", elastic.energy_elastic);
    if (is_with_examples)
      append(row, "energy_example", elastic.energy_example());
    if (mass != nullptr)
      append(row, "energy_kinetic", sums.kinetic_energy);
    append_dissipated(row, shown);
    append_terms(row);
    append_weights(row, shown, report);
    const bool is_shell = problem.body.mesh.is_shell();
    append(row, is_shell ? "min_area" : "min_det_F", elastic.min_det_F);
    if (!is_shell)
      row.push_back({ "inverted_cells", elastic.inverted_cells });
    if (is_with_examples && !is_shell)
      row.push_back({ "guarded_cells", elastic.guarded_cells });
    if (mass != nullptr)
    {
      append(row, "momentum", sums.momentum);
      append(row, "angular_momentum", sums.angular_momentum);
    }
    append_work(row);
    const Handles &handles = problem.constraints.handles;
    for (unsigned int h = 0; h < handles.size(); ++h)
      append(row, "reaction_" + handles.name(h), handles.sum_over(h, problem.evaluation.gradient));
    return row;
  }

  void
  Diagnostics::append_dissipated(StatisticsRow &row, const State &shown) const
  {
    const bool some_yield = problem.has_trait(&ModelTraits::dissipated);
    if (problem.potential.get_weights().get_memory().in_use() || some_yield
        || problem.potential.has_dissipating_terms(shown))
      append(row, "energy_dissipated",
             shown.dissipated
                 + (some_yield ? problem.body.exchange().sum(
                        problem.cells().get_field().dissipated_energy())
                               : 0.));
  }

  void
  Diagnostics::append_terms(StatisticsRow &row) const
  {
    const auto                                 &terms = problem.potential.get_terms();
    std::vector<std::pair<std::string, double>> columns;
    for (std::size_t i = 0; i < terms.size(); ++i)
      terms[i]->append_columns(problem.evaluation.term_energies[i], columns);
    for (const auto &[name, value] : columns)
      append(row, name, value);
  }

  void
  Diagnostics::append_weights(StatisticsRow     &row,
                              const State       &shown,
                              const SolveReport &report) const
  {
    const ExamplePoses &poses = problem.examples.poses;
    for (unsigned int i = 0; i < shown.weights.size(); ++i)
      append(row, name_of_weight("weight", poses, i), shown.weights[i]);
    if (problem.examples.weights.n_unknown() == 0)
      return;
    for (unsigned int region = 0; region < shown.multipliers.size(); ++region)
      append(row, name_of_region("multiplier", poses, region), shown.multipliers[region]);
    append(row, "kkt_residual", report.kkt_residual);
  }

  void
  Diagnostics::append_work(StatisticsRow &row) const
  {
    const Loads *loads = problem.actions.loads.get();
    if (problem.constraints.handles.size() > 0)
      append(row, "work_handles", work.handles);
    if (loads != nullptr && loads->has_gravity())
      append(row, "work_gravity", work.gravity);
    if (loads != nullptr && loads->has_named_loads())
      append(row, "work_loads", work.loads);
  }

  void
  Diagnostics::append_seconds(StatisticsRow &row, const std::optional<PhaseSeconds> &seconds)
  {
    const auto append_one = [&](const std::string &name, const double value)
    {
      row.push_back({ "seconds_" + name });
      if (seconds)
        row.back().value = value;
    };
    append_one("step", seconds ? std::accumulate(seconds->begin(), seconds->end(), 0.) : 0.);
    for (unsigned int phase = 0; phase < n_phases; ++phase)
      if (phase != static_cast<unsigned int>(Phase::read))
        append_one(phase_names[phase], seconds ? (*seconds)[phase] : 0.);
  }
} // namespace Exemplar
