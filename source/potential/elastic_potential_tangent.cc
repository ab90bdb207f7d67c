// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/elastic_potential.h>
#include <exemplar/potential/stretch_stiffness.h>

#include <algorithm>

// The matrix A and the columns G of a step: R K R^T, for which four vectors are turned and
// no matrix is multiplied, and the tangents of the models.

namespace Exemplar
{
  void
  ElasticPotential::add_mixed_cells(const CellTask      &task,
                                    TangentTask          tangent,
                                    const bool           rotated,
                                    std::vector<double> &values)
  {
    // rows of a block are not consecutive there: the kernel writes whole blocks apart
    constexpr std::size_t n = n_block_columns;
    for (const unsigned int cell : scatter.mixed_cells())
    {
      const std::size_t batch = cell / batch_size, lane = cell % batch_size;
      std::vector<int>  apart(n * batch_size, FreeDofs::held);
      double            blocks[3 * n + SymmetricPattern::padding] = {};
      for (std::size_t column = 0; column < n; ++column)
        apart[n * lane + column] = static_cast<int>(3 * column);
      tangent.positions = apart.data();
      tangent.values    = blocks;
      (rotated ? cells.loops().add_rotated_stiffness : cells.loops().add_tangent)(task, tangent,
                                                                                  batch, batch + 1);
      scatter.add_blocks(cells, cell, blocks, values);
    }
  }

  void
  ElasticPotential::assemble_coupling(const CellTask      &task,
                                      const TangentTask   &tangent,
                                      const bool           rotated,
                                      std::vector<double> &columns) const
  {
    const ExamplePoses &examples = *parts.examples;
    const std::size_t   n = parts.free_dofs.size(), n_strained = task.examples.n;
    columns.assign(n * examples.n_strained_weights(), 0.);
    dealii::AlignedVector<double> forces(12 * batch_size * n_strained);
    for (unsigned int cell = 0; cell < parts.fe_space.n_cells(); ++cell)
    {
      const std::size_t lane = cell % batch_size;
      if (lane == 0)
        cells.loops().coupling(task, tangent, rotated, cell / batch_size, forces.data());
      int dof[12];
      for (unsigned int p = 0; p < 12; ++p)
        dof[p] = parts.free_dofs.free_index(3 * cells.node(cell, p / 3) + p % 3);
      examples.for_each_weight(
          cell,
          [&](const unsigned int weight, const unsigned int i, const double share)
          {
            double       *column = columns.data() + n * examples.strained_index(weight);
            const double *force  = &forces[12 * batch_size * (i - task.examples.first) + lane];
            for (unsigned int p = 0; p < 12; ++p)
              if (dof[p] != FreeDofs::held)
                column[dof[p]] += share * force[p * batch_size];
          });
    }
  }

  void
  ElasticPotential::add_rotated_responses(const Vector      &displacement,
                                          ElasticEvaluation &result) const
  {
    for (const unsigned int cell : scatter.cells_beside_held_nodes())
    {
      const Matrix3<double> dF = parts.fe_space.deformation_gradient(cell, displacement);
      const Matrix3<double> de = symmetric_part(transpose_times(cells.rotation(cell), dF));
      add_force(cell, stress(damping.damped(cell, own_material(cell)), de), result.gradient);
      if (!result.weight_gradient.empty())
      {
        const Matrix3<double> dT = stress(own_material(cell), de);
        const double          factor
            = parts.examples->importance() * parts.fe_space.tetrahedron(cell).volume;
        parts.examples->for_each_weight(
            cell,
            [&](const unsigned int weight, const unsigned int i, const double share)
            {
              result.weight_gradient[weight]
                  -= share * factor * contract(dT, parts.examples->strain(cell, i));
            });
      }
    }
  }

  template <typename Cell>
  Cell
  ElasticPotential::cell_state(const Tangent              tangent,
                               const unsigned int         cell,
                               const Vector              &positions,
                               const std::vector<double> &weights) const
  {
    Cell state(own_material(cell), cells.rotation(cell),
               parts.fe_space.deformation_gradient(cell, positions), cells.get_guard_bound());
    state.scale_material(1. + damping.factor(cell));
    state.set_target(damping.damped(cell, example_strain(cell, weights)));
    if constexpr (Cell::traits.has_patches)
      if (dilatation != nullptr)
      {
        state.set_guard_material(parts.material.elasticity(cell));
        state.add_pressure(dilatation->pressure(cell));
      }
    if constexpr (!Cell::traits.convex_is_rotated)
      if (tangent == Tangent::convex)
        state.make_convex();
    return state;
  }

  void
  ElasticPotential::assemble_tangent(const Tangent              tangent,
                                     const Vector              &positions,
                                     const std::vector<double> &weights,
                                     std::vector<double>       &matrix_values,
                                     std::vector<double>       &columns)
  {
    const bool rotated = is_rotated_stiffness(tangent);
    if (dilatation != nullptr)
      update_pressures(positions, weights);
    CellTask cell_task = task(positions, weights, RotationUse::keep);
    if (tangent == Tangent::convex)
      cell_task.damping = damping.arrays_of_all_cells();
    const TangentTask to
        = { tangent == Tangent::convex, scatter.positions(), matrix_values.data() };
    (rotated ? cells.loops().add_rotated_stiffness
             : cells.loops().add_tangent)(cell_task, to, 0, cell_task.cells.n_batches());
    add_mixed_cells(cell_task, to, rotated, matrix_values);
    const bool has_guard = traits_of(parts.model.strain).has_guard && !parts.model.is_frozen();
    if (tangent == Tangent::convex && has_guard)
      add_stretch_stiffness(parts.fe_space, parts.material, cells, scatter, dilatation.get(),
                            positions, matrix_values);
    if (has_unknown_weights())
      assemble_coupling(cell_task, to, rotated, columns);
    if (dilatation != nullptr)
    {
      dilatation->add_tangent(cells, tangent == Tangent::convex, matrix_values);
      if (has_unknown_weights())
        dilatation->add_coupling(cells, columns);
    }
  }

  template <typename Cell>
  void
  ElasticPotential::add_cell_responses(const Tangent              tangent,
                                       const Vector              &displacement,
                                       const Vector              &positions,
                                       const std::vector<double> &weights,
                                       ElasticEvaluation         &result) const
  {
    for (const unsigned int cell : scatter.cells_beside_held_nodes())
    {
      const Cell            state = cell_state<Cell>(tangent, cell, positions, weights);
      const Matrix3<double> M     = transpose_times(
              cells.rotation(cell), parts.fe_space.deformation_gradient(cell, displacement));
      add_force(cell, state.response(M), result.gradient);
      if (result.weight_gradient.empty())
        continue;
      const double factor = parts.examples->importance() / (1. + damping.factor(cell))
                            * parts.fe_space.tetrahedron(cell).volume;
      parts.examples->for_each_weight(
          cell,
          [&](const unsigned int weight, const unsigned int i, const double share)
          {
            result.weight_gradient[weight]
                -= share * factor
                   * contract(state.example_response(parts.examples->strain(cell, i)), M);
          });
    }
  }

  void
  ElasticPotential::add_response(const Tangent              tangent,
                                 const Vector              &displacement,
                                 const Vector              &positions,
                                 const std::vector<double> &weights,
                                 ElasticEvaluation         &result)
  {
    cells.refresh_rotations();
    if (dilatation != nullptr)
    {
      update_pressures(positions, weights);
      dilatation->add_response(cells, displacement, result);
    }
    if (is_rotated_stiffness(tangent))
    {
      add_rotated_responses(displacement, result);
      return;
    }
    with_cell_model<double>(parts.model.strain,
                            [&](auto model)
                            {
                              using Cell = typename decltype(model)::type;
                              if constexpr (!Cell::traits.exact_is_rotated)
                                add_cell_responses<Cell>(tangent, displacement, positions, weights,
                                                         result);
                            });
  }

  void
  ElasticPotential::add_force(const unsigned int     cell,
                              const Matrix3<double> &dP,
                              Vector                &gradient) const
  {
    Vector3<double> force[4];
    frozen_forces(parts.fe_space.tetrahedron(cell), cells.rotation(cell), dP, force);
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int c = 0; c < 3; ++c)
        gradient[3 * parts.fe_space.nodes(cell)[a] + c] += force[a][c];
  }
} // namespace Exemplar
