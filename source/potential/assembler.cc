// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/environment.h>
#include <exemplar/potential/assembler.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Exemplar
{
  namespace
  {
    /// Cells are summed in stripes, each by one thread. How many there are depends on the mesh
    /// alone, so that the sums do not depend on the number of threads.
    std::size_t
    choose_n_stripes(const std::size_t n_cells)
    {
      return std::clamp<std::size_t>(n_cells / 50000, 2, 16);
    }

    /// What the cells of a stripe sum up.
    struct StripeSums
    {
      CellSums                      cells;
      dealii::AlignedVector<double> weights; ///< lanes of each weight
    };

    std::vector<double>
    sum_of_lanes(const dealii::AlignedVector<double> &lanes)
    {
      std::vector<double> sums(lanes.size() / batch_size, 0.);
      for (std::size_t i = 0; i < lanes.size(); ++i)
        sums[i / batch_size] += lanes[i];
      return sums;
    }
  } // namespace

  Assembler::Assembler(const ModelParameters &model,
                       const FESpace         &fe_space,
                       const Material        &material,
                       const ExamplePoses    *examples,
                       const Inertia         *inertia,
                       const FreeDofs        &free_dofs)
      : model(model), fe_space(fe_space), material(material), examples(examples), inertia(inertia),
        free_dofs(free_dofs), guard_bound(model.is_frozen()     ? no_guard
                                          : examples == nullptr ? default_guard_bound
                                                                : examples->guard_bound()),
        kernels(best_kernels()), batches(fe_space, material),
        n_stripes(choose_n_stripes(fe_space.n_cells())), node_positions(4 * fe_space.n_nodes()),
        nodal_sums(4 * n_stripes * fe_space.n_nodes())
  {
    estimate_rounding();
    build_pattern();
    build_block_positions();
    if (inertia != nullptr)
      build_mass_values();
  }

  void
  Assembler::estimate_rounding()
  {
    // F of Eq. (1) carries the rounding of the positions, divided by the cell's size
    const double rounding
        = 2. * std::numeric_limits<double>::epsilon() * fe_space.rest_positions().linfty_norm();
    dealii::Vector<double> force(fe_space.n_nodes());
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      const CellMaterial<double> &lame     = material.elasticity(cell);
      const Tetrahedron<double>  &tet      = fe_space.tetrahedron(cell);
      double                      norms[4] = {};
      for (unsigned int a = 0; a < 4; ++a)
        norms[a] = std::sqrt(dot(tet.shape_gradient[a], tet.shape_gradient[a]));
      const double strain = rounding * *std::max_element(norms, norms + 4);
      const double stress = strain * (std::abs(lame.lambda) + 2. * lame.mu);
      rounding_stress_norm += tet.volume * stress * stress;
      for (unsigned int a = 0; a < 4; ++a)
        force[fe_space.nodes(cell)[a]] += std::pow(tet.volume * stress * norms[a], 2);
    }
    greatest_rounding_force = std::sqrt(force.linfty_norm()); // cells round independently
    rounding_stress_norm    = std::sqrt(rounding_stress_norm);
  }

  double
  Assembler::rounding_weight_gradient(const unsigned int weight) const
  {
    return examples->importance() * rounding_stress_norm * examples->strain_norm(weight);
  }

  void
  Assembler::build_pattern()
  {
    const dealii::SparsityPattern nodal = fe_space.nodal_pattern();
    pattern.column_start.push_back(0);
    for (const unsigned int dof : free_dofs.list())
    {
      const auto begin = pattern.row.size();
      for (auto entry = nodal.begin(dof / 3); entry != nodal.end(dof / 3); ++entry)
        for (unsigned int c = 0; c < 3; ++c)
          if (const unsigned int other = 3 * entry->column() + c; other >= dof)
            if (const int row = free_dofs.free_index(other); row != FreeDofs::held)
              pattern.row.push_back(row);
      std::sort(pattern.row.begin() + begin, pattern.row.end());
      pattern.column_start.push_back(pattern.row.size());
    }
  }

  void
  Assembler::build_block_positions()
  {
    const auto n_held = [this](const unsigned int node)
    {
      int n = 0;
      for (unsigned int c = 0; c < 3; ++c)
        n += (free_dofs.free_index(3 * node + c) == FreeDofs::held);
      return n;
    };
    block_positions.assign(n_block_columns * fe_space.n_cells(), FreeDofs::held);
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      int held[4];
      for (unsigned int a = 0; a < 4; ++a)
        held[a] = n_held(batches.node(cell, a));
      if (std::any_of(held, held + 4, [](const int n) { return n > 0; }))
        cells_beside_held_nodes.push_back(cell);
      if (std::any_of(held, held + 4, [](const int n) { return n == 1 || n == 2; }))
      {
        mixed_cells.push_back(cell);
        continue;
      }
      int *position = &block_positions[n_block_columns * cell];
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int b = 0; b <= a; ++b)
          for (unsigned int j = 0; j < 3; ++j, ++position)
            if (held[a] == 0 && held[b] == 0)
            {
              const int column = free_dofs.free_index(3 * batches.node(cell, b) + j);
              *position        = a == b ? pattern.position(column, column) - static_cast<int>(j)
                                        : pattern.position(free_dofs.free_index(3 * batches.node(cell, a)),
                                                           column);
            }
    }
  }

  void
  Assembler::build_mass_values()
  {
    mass_values.assign(pattern.n_values(), 0.);
    const dealii::SparseMatrix<double> &mass = inertia->nodal_mass();
    for (const unsigned int dof : free_dofs.list())
      for (auto entry = mass.begin(dof / 3); entry != mass.end(dof / 3); ++entry)
      {
        const unsigned int other = 3 * entry->column() + dof % 3;
        if (other >= dof && free_dofs.free_index(other) != FreeDofs::held)
          mass_values[pattern.position(free_dofs.free_index(other), free_dofs.free_index(dof))]
              = entry->value();
      }
  }

  CellTask
  Assembler::task(const dealii::Vector<double> &positions,
                  const std::vector<double>    &weights,
                  const RotationUse             rotations)
  {
    if (rotations == RotationUse::keep)
      refresh_rotations();
    rotations_are_forgotten = rotations == RotationUse::find_and_forget;
    CellTask task;
    task.cells = batches.arrays(model.strain, guard_bound);
    if (examples != nullptr)
      task.examples = examples->arrays();
    if (damping > 0.)
      task.damping = { cell_damping.data(), damping_strains.data() };
    for (unsigned int node = 0; node < fe_space.n_nodes(); ++node)
      for (unsigned int c = 0; c < 3; ++c)
        node_positions[4 * node + c] = positions[3 * node + c];
    task.positions        = node_positions.data();
    task.weights          = weights.data();
    task.rotation_use     = rotations;
    task.with_weight_sums = has_weights();
    return task;
  }

  void
  Assembler::update_rotations(const dealii::Vector<double> &positions)
  {
    if (model.strain == StrainMeasure::corotational)
    {
      const CellTask cells = task(positions, {}, RotationUse::update);
      kernels.update_rotations(cells, 0, cells.cells.n_batches());
    }
  }

  void
  Assembler::refresh_rotations()
  {
    if (!rotations_are_forgotten)
      return;
    CellTask last;
    last.cells     = batches.arrays(model.strain, guard_bound);
    last.positions = node_positions.data();
    kernels.update_rotations(last, 0, last.cells.n_batches());
    rotations_are_forgotten = false;
  }

  void
  Assembler::node_rotations(std::vector<float> &rotations)
  {
    refresh_rotations();
    const CellArrays cells = batches.arrays(model.strain, guard_bound);
    CellTask         task;
    task.cells = cells;
    rotation_sums.resize(12 * fe_space.n_nodes());
    rotation_sums.fill(0.);
    rotations.resize(9 * fe_space.n_nodes());
    kernels.add_rotations(task, 0, cells.n_batches(), rotation_sums.data());
    kernels.closest_rotations(fe_space.n_nodes(), rotation_sums.data(), rotations.data());
  }

  void
  Assembler::set_damping(const double s, const std::vector<WeightedPositions> &history)
  {
    damping = s;
    cell_damping.resize_fast(0);
    damping_strains.resize_fast(0);
    if (s == 0.)
      return;
    cell_damping.resize(batched_size(fe_space.n_cells(), 1), s);
    damping_strains.resize(batched_size(fe_space.n_cells(), 6), 0.);
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      for (const WeightedPositions &past : history)
      {
        const Matrix3<double> F       = fe_space.deformation_gradient(cell, *past.positions);
        const Matrix3<double> R       = model_rotation(model.strain, F);
        const Matrix3<double> e       = model_strain(model.strain, R, F);
        const double          part[6] = { e[0][0], e[1][1], e[2][2], e[1][2], e[0][2], e[0][1] };
        for (unsigned int k = 0; k < 6; ++k)
          damping_strains[batch_index(cell, 6, k)] += past.weight * part[k];
        if (model.strain == StrainMeasure::corotational
            && CorotationalCell<double>(material.elasticity(cell), R, F, guard_bound).is_guarded())
          cell_damping[cell] = 0.;
      }
  }

  Matrix3<double>
  Assembler::example_target(const unsigned int cell, const std::vector<double> &weights) const
  {
    if (examples == nullptr)
      return Matrix3<double>{};
    const Matrix3<double> E = examples->strain(cell, weights);
    return combine(examples->importance(), E, 0., E);
  }

  CellMaterial<double>
  Assembler::damped_lame(const unsigned int cell) const
  {
    const CellMaterial<double> &lame = material.elasticity(cell);
    return { (1. + damping_of(cell)) * lame.lambda, (1. + damping_of(cell)) * lame.mu };
  }

  Matrix3<double>
  Assembler::damped_target(const unsigned int cell, const Matrix3<double> &target) const
  {
    const double s = damping_of(cell);
    if (s == 0.)
      return target;
    return combine(1. / (1. + s), target, s / (1. + s), damping_strain(cell));
  }

  void
  Assembler::add_penalty(const std::vector<double> &weights,
                         const double               stress_norm,
                         Evaluation                &result) const
  {
    for (unsigned int v = 0; v < weights.size(); ++v)
    {
      double penalty = 0.;
      for (unsigned int w = 0; w < weights.size(); ++w)
        penalty += examples->penalty_matrix()(v, w) * weights[w];
      result.energy += 0.5 * penalty * weights[v];
      result.weight_gradient[v] += penalty;
      result.weight_scale = std::max(result.weight_scale,
                                     examples->importance() * stress_norm * examples->strain_norm(v)
                                         + std::abs(penalty));
    }
  }

  void
  Assembler::gather_forces(Evaluation &result) const
  {
    result.gradient.reinit(fe_space.n_dofs(), true);
    result.force_scale.reinit(fe_space.n_nodes(), true);
    for (unsigned int node = 0; node < fe_space.n_nodes(); ++node)
    {
      double sum[4] = {};
      for (std::size_t stripe = 0; stripe < n_stripes; ++stripe)
        for (unsigned int c = 0; c < 4; ++c)
          sum[c] += nodal_sums[4 * (stripe * fe_space.n_nodes() + node) + c];
      for (unsigned int c = 0; c < 3; ++c)
        result.gradient[3 * node + c] = sum[c];
      result.force_scale[node] = sum[3];
    }
  }

  void
  Assembler::evaluate(const dealii::Vector<double> &positions,
                      const std::vector<double>    &weights,
                      Evaluation                   &result,
                      const RotationUse             rotations,
                      const std::vector<double>    *weight_linear_term)
  {
    CellTask cells = task(positions, weights, rotations);
    cells.with_weight_sums &= weight_linear_term == nullptr;
    std::vector<StripeSums> stripes(n_stripes);
    nodal_sums.fill(0.);
    const ParallelRegion region;
    // to start a thread costs as much as a thousand cells
    const int n_at_once = fe_space.n_cells() < 4000 ? 1 : static_cast<int>(n_threads());
#pragma omp parallel for num_threads(n_at_once)
    for (std::size_t stripe = 0; stripe < n_stripes; ++stripe)
    {
      stripes[stripe].weights.resize(has_weights() ? batch_size * weights.size() : 0);
      kernels.evaluate(cells, stripe * cells.cells.n_batches() / n_stripes,
                       (stripe + 1) * cells.cells.n_batches() / n_stripes,
                       &nodal_sums[4 * stripe * fe_space.n_nodes()], stripes[stripe].weights.data(),
                       stripes[stripe].cells);
    }
    CellSums                      sums;
    dealii::AlignedVector<double> weight_sums(has_weights() ? batch_size * weights.size() : 0);
    for (const StripeSums &stripe : stripes)
    {
      sums += stripe.cells;
      for (std::size_t i = 0; i < weight_sums.size(); ++i)
        weight_sums[i] += stripe.weights[i];
    }
    gather_forces(result);
    result.weight_gradient = sum_of_lanes(weight_sums);
    result.weight_scale    = 0.;
    result.energy_elastic  = sums.energy_elastic;
    result.energy          = sums.energy;
    result.energy_damping  = sums.energy_damping;
    result.min_det_F       = sums.min_det_F;
    result.inverted_cells  = sums.inverted_cells;
    result.guarded_cells   = sums.guarded_cells;
    if (!has_weights())
      return;
    add_penalty(weights, std::sqrt(sums.stress_square), result);
    if (weight_linear_term != nullptr)
      for (unsigned int v = 0; v < weights.size(); ++v)
      {
        result.weight_gradient[v] = -(*weight_linear_term)[v];
        for (unsigned int w = 0; w < weights.size(); ++w)
          result.weight_gradient[v] += examples->weight_matrix()(v, w) * weights[w];
      }
  }

  std::vector<double>
  Assembler::weight_linear_term(const dealii::Vector<double> &positions,
                                const RotationUse             rotations)
  {
    const CellTask                cells = task(positions, {}, rotations);
    dealii::AlignedVector<double> weight_sums(batch_size * examples->n_weights());
    kernels.weight_linear_term(cells, 0, cells.cells.n_batches(), weight_sums.data());
    return sum_of_lanes(weight_sums);
  }

  CellResults
  Assembler::cell_results(const dealii::Vector<double> &positions,
                          const std::vector<double>    &weights)
  {
    refresh_rotations();
    const unsigned int n = fe_space.n_cells();
    CellResults results{ std::vector<double>(n), std::vector<double>(n), std::vector<double>(n) };
    for (unsigned int cell = 0; cell < n; ++cell)
    {
      const CellMaterial<double> &lame   = material.elasticity(cell);
      const Matrix3<double>       F      = fe_space.deformation_gradient(cell, positions);
      const Matrix3<double>       strain = model_strain(model.strain, batches.rotation(cell), F);
      Matrix3<double>             T      = stress(lame, strain);

      results.strain_energy_density[cell] = 0.5 * contract(T, strain);
      results.det_F[cell]                 = determinant(F);
      if (examples != nullptr)
        T = stress(lame, combine(1., strain, -1., example_target(cell, weights)));
      const double third = trace(T) / 3.;
      for (int i = 0; i < 3; ++i)
        T[i][i] -= third;
      results.von_mises_stress[cell] = std::sqrt(1.5 * contract(T, T));
    }
    return results;
  }

  std::size_t
  Assembler::memory_consumption() const
  {
    using dealii::MemoryConsumption::memory_consumption;
    return batches.memory_consumption() + memory_consumption(pattern.column_start)
           + memory_consumption(pattern.row) + memory_consumption(block_positions)
           + memory_consumption(mixed_cells) + memory_consumption(cells_beside_held_nodes)
           + rotation_sums.memory_consumption() + node_positions.memory_consumption()
           + nodal_sums.memory_consumption() + memory_consumption(mass_values)
           + cell_damping.memory_consumption() + damping_strains.memory_consumption();
  }
} // namespace Exemplar
