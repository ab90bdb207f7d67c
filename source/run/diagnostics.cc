// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/diagnostics.h>

#include <cmath>

namespace Exemplar
{
  namespace
  {
    void
    append(StatisticsRow &row, const std::string &column, const double value)
    {
      row.emplace_back(column, shortest_text(value));
    }

    void
    append(StatisticsRow &row, const std::string &column, const dealii::Tensor<1, 3> &value)
    {
      for (unsigned int c = 0; c < 3; ++c)
        append(row, column + "_" + "xyz"[c], value[c]);
    }
  } // namespace

  Diagnostics::Diagnostics(const Handles        *handles,
                           const Loads          *loads,
                           const ExampleWeights *weights,
                           const Mass           *mass,
                           const bool            energy_is_bounded)
      : handles(handles), loads(loads), weights(weights), mass(mass),
        energy_is_bounded(energy_is_bounded)
  {
  }

  void
  Diagnostics::add_work(const dealii::Vector<double> &old_positions,
                        const State                  &state,
                        const dealii::Vector<double> &gradient)
  {
    dealii::Vector<double> displacement = state.positions;
    displacement -= old_positions;
    if (handles != nullptr)
      for (const unsigned int dof : handles->held_dofs())
        work.handles += gradient[dof] * displacement[dof];
    if (loads != nullptr && loads->has_gravity())
      work.gravity += loads->gravity() * displacement;
    if (loads != nullptr && loads->has_named_loads())
    {
      dealii::Vector<double> force(displacement.size());
      loads->named_loads(state.time, force);
      work.loads += force * displacement;
    }
  }

  StatisticsRow
  Diagnostics::row(const State       &state,
                   const SolveReport &report,
                   const Evaluation  &evaluation) const
  {
    const ElasticEvaluation &elastic = evaluation.elastic;
    StatisticsRow            row     = { { "step", std::to_string(state.step) },
                                         { "time", shortest_text(state.time) },
                                         { "status", status_name(report.status) },
                                         { "iterations", std::to_string(report.iterations) } };
    append(row, "residual", report.status == SolveStatus::failed ? std::nan("") : report.residual);
    append(row, "energy_elastic", elastic.energy_elastic);
    if (weights != nullptr)
      append(row, "energy_example", elastic.energy_example());
    const MotionSums sums = mass != nullptr ? mass->motion_sums(state) : MotionSums();
    if (mass != nullptr)
      append(row, "energy_kinetic", sums.kinetic_energy);
    if (energy_is_bounded)
      append(row, "energy_inertia", evaluation.term_energies.front());
    for (unsigned int i = 0; i < state.weights.size(); ++i)
      append(row, weights->weight_name("weight", i), state.weights[i]);
    if (weights != nullptr && weights->are_unknown())
    {
      for (unsigned int region = 0; region < state.multipliers.size(); ++region)
        append(row, weights->region_name("multiplier", region), state.multipliers[region]);
      append(row, "kkt_residual", report.kkt_residual);
    }
    append(row, "min_det_F", elastic.min_det_F);
    row.emplace_back("inverted_cells", std::to_string(elastic.inverted_cells));
    if (weights != nullptr)
      row.emplace_back("guarded_cells", std::to_string(elastic.guarded_cells));
    if (mass != nullptr)
    {
      append(row, "momentum", sums.momentum);
      append(row, "angular_momentum", sums.angular_momentum);
    }
    if (handles != nullptr)
      append(row, "work_handles", work.handles);
    if (loads != nullptr && loads->has_gravity())
      append(row, "work_gravity", work.gravity);
    if (loads != nullptr && loads->has_named_loads())
      append(row, "work_loads", work.loads);
    if (handles != nullptr)
      for (unsigned int h = 0; h < handles->size(); ++h)
        append(row, "reaction_" + handles->name(h), handles->sum_over(h, evaluation.gradient));
    return row;
  }

  void
  Diagnostics::append_seconds(StatisticsRow &row, const std::optional<PartSeconds> &seconds)
  {
    double total = 0.;
    for (unsigned int part = 0; seconds && part < n_parts; ++part)
      total += (*seconds)[part];
    row.emplace_back("seconds_step", seconds ? shortest_text(total) : "");
    for (unsigned int part = 0; part < n_parts; ++part)
      if (part != static_cast<unsigned int>(Part::read))
        row.emplace_back("seconds_" + part_names[part],
                         seconds ? shortest_text((*seconds)[part]) : "");
  }
} // namespace Exemplar
