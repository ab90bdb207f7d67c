// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/algebra/weight_qp.h>
#include <exemplar/solvers/turned_factor.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace Exemplar
{
  namespace
  {
    // Nanoseconds on the machine of doc/results.md; only their ratio matters.

    double
    factorization_cost(const FactorPanels &panels)
    {
      double operations = 0.;
      for (std::size_t s = 0; s + 1 < panels.first_column.size(); ++s)
      {
        const auto n_rows = static_cast<double>(panels.first_row[s + 1] - panels.first_row[s]);
        for (int k = 0; k < panels.first_column[s + 1] - panels.first_column[s]; ++k)
          operations += (n_rows - k) * (n_rows - k);
      }
      return 0.022 * operations + 7. * static_cast<double>(panels.values.size());
    }

    double
    iteration_cost(const FactorPanels &panels)
    {
      return 60. * static_cast<double>(panels.permutation.size())
             + 0.25 * static_cast<double>(panels.values.size());
    }
  } // namespace

  TurnedFactor::TurnedFactor(const FreeDofs &free_dofs) : free_dofs(free_dofs) {}

  void
  TurnedFactor::find_turned_nodes()
  {
    turned_nodes.clear();
    for (unsigned int node = 0; 3 * node < free_dofs.n_dofs(); ++node)
      if (free_dofs.free_index(3 * node) != FreeDofs::held
          && free_dofs.free_index(3 * node + 1) != FreeDofs::held
          && free_dofs.free_index(3 * node + 2) != FreeDofs::held)
        turned_nodes.push_back(node);
    turns.resize(9 * turned_nodes.size());
    right_side.resize(free_dofs.size());
  }

  void
  TurnedFactor::reinit(SpdOperator              &matrix,
                       const WeightBlock        &block,
                       const std::vector<float> &rotations)
  {
    if (empty()) // the first time
      find_turned_nodes();
    rotations_then      = rotations;
    FactorPanels panels = matrix.panels();
    relative_cost       = factorization_cost(panels) / iteration_cost(panels);
    factor              = SinglePrecisionFactor(std::move(panels));
    coupled             = block.coupled;
    sums                = block.N;
    schur               = block.H;
    if (coupled.empty())
      return;
    std::vector<double> columns = block.coupling;
    matrix.solve(columns);
    const std::size_t n = free_dofs.size();
    for (std::size_t i = 0; i < coupled.size(); ++i)
      for (std::size_t j = 0; j < coupled.size(); ++j)
        schur(coupled[i], coupled[j]) -= std::inner_product(block.coupling.begin() + i * n,
                                                            block.coupling.begin() + (i + 1) * n,
                                                            columns.begin() + j * n, 0.);
    G.assign(block.coupling.begin(), block.coupling.end());
    Z.assign(columns.begin(), columns.end());
  }

  void
  TurnedFactor::turn(const std::vector<float> &rotations)
  {
    for (std::size_t k = 0; k < turned_nodes.size(); ++k)
    {
      const float *now  = &rotations[9 * turned_nodes[k]],
                  *then = &rotations_then[9 * turned_nodes[k]];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          turns[9 * k + 3 * i + j] = now[3 * i] * then[3 * j] + now[3 * i + 1] * then[3 * j + 1]
                                     + now[3 * i + 2] * then[3 * j + 2];
    }
  }

  void
  TurnedFactor::multiply_by_turns(std::vector<double> &vector,
                                  const int            row,
                                  const int            column) const
  {
    for (std::size_t k = 0; k < turned_nodes.size(); ++k)
    {
      const float *W = &turns[9 * k];
      double      *v = &vector[free_dofs.free_index(3 * turned_nodes[k])];
      const double x = v[0], y = v[1], z = v[2];
      for (int i = 0; i < 3; ++i)
        v[i] = W[row * i] * x + W[row * i + column] * y + W[row * i + 2 * column] * z;
    }
  }

  std::vector<double>
  TurnedFactor::find_weight_changes(const std::vector<double> &forces,
                                    const std::vector<double> &weight_gradient,
                                    const std::vector<double> &lower) const
  {
    const std::size_t n = forces.size();
    // what holds weights at their bounds is part of the model
    std::vector<double> c(weight_gradient.size());
    std::transform(weight_gradient.begin(), weight_gradient.end(), c.begin(), std::negate<>());
    for (std::size_t j = 0; j < coupled.size(); ++j)
      c[coupled[j]] += dot(forces, &Z[j * n]);
    const WeightQpSolution change = minimize_over_weights(
        schur, c, std::vector<double>(sums.m(), 0.), lower, std::vector<double>(c.size(), 0.));
    return change.found ? change.weights : std::vector<double>(c.size(), 0.);
  }

  void
  TurnedFactor::add_example_forces(const std::vector<double> &weights,
                                   std::vector<double>       &forces) const
  {
    const std::size_t n = forces.size();
    for (std::size_t j = 0; j < coupled.size(); ++j)
      if (const double weight = weights[coupled[j]]; weight != 0.)
        add(forces, weight, &G[j * n]);
  }

  void
  TurnedFactor::solve(std::vector<double> &vector)
  {
    // of forces that shrink by ten orders single precision would lose the last
    const double scale = greatest_entry(vector);
    if (scale == 0.)
      return;
    for (std::size_t i = 0; i < vector.size(); ++i)
      right_side[i] = static_cast<float>(vector[i] / scale);
    factor.solve(right_side);
    for (std::size_t i = 0; i < vector.size(); ++i)
      vector[i] = scale * right_side[i];
  }

  std::size_t
  TurnedFactor::memory_consumption() const
  {
    using dealii::MemoryConsumption::memory_consumption;
    return factor.memory_consumption() + memory_consumption(turned_nodes)
           + memory_consumption(rotations_then) + memory_consumption(turns)
           + memory_consumption(coupled) + memory_consumption(G) + memory_consumption(Z)
           + memory_consumption(right_side) + schur.memory_consumption()
           + sums.memory_consumption();
  }
} // namespace Exemplar
