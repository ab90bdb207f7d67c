// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/algebra/weight_qp.h>
#include <exemplar/solvers/rotated_metric.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>
#include <functional>

namespace Exemplar
{
  RotatedMetric::RotatedMetric(const FreeDofs &free_dofs) : free_dofs(free_dofs) {}

  void
  RotatedMetric::find_rotated_nodes()
  {
    rotated_nodes.clear();
    for (unsigned int node = 0; 3 * node < free_dofs.n_dofs(); ++node)
      if (free_dofs.unknown_index(3 * node) != FreeDofs::held
          && free_dofs.unknown_index(3 * node + 1) != FreeDofs::held
          && free_dofs.unknown_index(3 * node + 2) != FreeDofs::held)
        rotated_nodes.push_back(node);
    rotations_since.resize(9 * rotated_nodes.size());
  }

  void
  RotatedMetric::reinit(const BorderedSystem      &system,
                        const std::vector<double> &inverse_columns,
                        const std::vector<float>  &rotations)
  {
    if (empty()) // the first time
      find_rotated_nodes();
    ++n_reinits;
    rotations_then = rotations;
    inverse        = system.keep();
    form           = &system.weight_form();
    schur = make_schur_complement(*form, system.columns(), inverse_columns.data(), free_dofs.size(),
                                  free_dofs.exchange());
    G.assign(system.columns().begin(), system.columns().end());
    Z.assign(inverse_columns.begin(), inverse_columns.end());
  }

  void
  RotatedMetric::rotate(const std::vector<float> &rotations)
  {
    for (std::size_t k = 0; k < rotated_nodes.size(); ++k)
    {
      const float *now  = &rotations[9 * rotated_nodes[k]],
                  *then = &rotations_then[9 * rotated_nodes[k]];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          rotations_since[9 * k + 3 * i + j] = now[3 * i] * then[3 * j]
                                               + now[3 * i + 1] * then[3 * j + 1]
                                               + now[3 * i + 2] * then[3 * j + 2];
    }
  }

  void
  RotatedMetric::multiply_by_rotations(std::vector<double> &vector,
                                       const int            row,
                                       const int            column) const
  {
    for (std::size_t k = 0; k < rotated_nodes.size(); ++k)
    {
      const float *W = &rotations_since[9 * k];
      double      *v = &vector[free_dofs.unknown_index(3 * rotated_nodes[k])];
      const double x = v[0], y = v[1], z = v[2];
      for (int i = 0; i < 3; ++i)
        v[i] = W[row * i] * x + W[row * i + column] * y + W[row * i + 2 * column] * z;
    }
  }

  dealii::Tensor<1, 3>
  RotatedMetric::rotate_back(const unsigned int node, const dealii::Tensor<1, 3> &vector) const
  {
    const auto place = std::lower_bound(rotated_nodes.begin(), rotated_nodes.end(), node);
    if (place == rotated_nodes.end() || *place != node)
      return vector; // held in part
    const float         *W = &rotations_since[9 * (place - rotated_nodes.begin())];
    dealii::Tensor<1, 3> result;
    for (int i = 0; i < 3; ++i)
      result[i] = W[i] * vector[0] + W[i + 3] * vector[1] + W[i + 6] * vector[2];
    return result;
  }

  std::vector<double>
  RotatedMetric::find_weight_changes(const std::vector<double> &forces,
                                     const std::vector<double> &weight_gradient,
                                     const WeightLimits        &limits) const
  {
    const std::size_t n = forces.size();
    // the derivatives stay in the linear term although they do not vanish at the minimum: they
    // are what holds weights at their bounds
    std::vector<double> c(weight_gradient.size());
    std::transform(weight_gradient.begin(), weight_gradient.end(), c.begin(), std::negate<>());
    for (std::size_t j = 0; j < form->coupled.size(); ++j)
      c[form->coupled[j]] += free_dofs.exchange().sum(dot(forces, &Z[j * n]));
    const std::vector<double> none(c.size(), 0.), sums(form->N.m(), 0.);
    const WeightQpSolution    change = minimize_over_weights(*form, schur, c, sums, limits, none);
    return change.found ? change.weights : none;
  }

  void
  RotatedMetric::add_example_forces(const std::vector<double> &weights,
                                    std::vector<double>       &forces) const
  {
    const std::size_t n = forces.size();
    for (std::size_t j = 0; j < form->coupled.size(); ++j)
      if (const double weight = weights[form->coupled[j]]; weight != 0.)
        add(forces, weight, &G[j * n]);
  }

  void
  RotatedMetric::add_example_responses(const std::vector<double> &weights,
                                       std::vector<double>       &step) const
  {
    const std::size_t n = step.size();
    for (std::size_t j = 0; j < form->coupled.size(); ++j)
      if (const double weight = weights[form->coupled[j]]; weight != 0.)
        add(step, weight, &Z[j * n]);
  }

  std::size_t
  RotatedMetric::memory_consumption() const
  {
    using dealii::MemoryConsumption::memory_consumption;
    return (empty() ? 0 : inverse->memory_consumption()) + memory_consumption(rotated_nodes)
           + memory_consumption(rotations_then) + memory_consumption(rotations_since)
           + memory_consumption(G) + memory_consumption(Z) + schur.memory_consumption();
  }
} // namespace Exemplar
