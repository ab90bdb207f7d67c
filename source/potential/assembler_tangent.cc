// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/assembler.h>

#include <algorithm>
#include <type_traits>

// The matrix A and the columns G of a step: R K R^T, for which four vectors are turned and
// no matrix is multiplied, and the tangents of the models.

namespace Exemplar
{
  void
  Assembler::start_matrix(std::vector<double> &matrix_values) const
  {
    if (inertia == nullptr)
      std::fill(matrix_values.begin(), matrix_values.end(), 0.);
    else
      for (std::size_t i = 0; i < matrix_values.size(); ++i)
        matrix_values[i] = inertia->matrix_factor() * mass_values[i];
  }

  void
  Assembler::add_mixed_cells(const CellTask &task, TangentTask tangent, const bool rotated)
  {
    // rows of a block are not consecutive there: the kernel writes whole blocks apart
    constexpr std::size_t n      = n_block_columns;
    double *const         values = tangent.values;
    for (const unsigned int cell : mixed_cells)
    {
      const std::size_t batch = cell / batch_size, lane = cell % batch_size;
      std::vector<int>  apart(n * batch_size, FreeDofs::held);
      double            blocks[3 * n + SymmetricPattern::padding] = {};
      for (std::size_t column = 0; column < n; ++column)
        apart[n * lane + column] = static_cast<int>(3 * column);
      tangent.positions = apart.data();
      tangent.values    = blocks;
      (rotated ? kernels.add_rotated_stiffness : kernels.add_tangent)(task, tangent, batch,
                                                                      batch + 1);
      const double *entry = blocks;
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int b = 0; b <= a; ++b)
          for (unsigned int j = 0; j < 3; ++j)
            for (unsigned int i = 0; i < 3; ++i, ++entry)
            {
              const int row    = free_dofs.free_index(3 * batches.node(cell, a) + i);
              const int column = free_dofs.free_index(3 * batches.node(cell, b) + j);
              if (row != FreeDofs::held && column != FreeDofs::held && row >= column)
                values[pattern.position(row, column)] += *entry;
            }
    }
  }

  void
  Assembler::assemble_coupling(const CellTask      &task,
                               const TangentTask   &tangent,
                               const bool           rotated,
                               std::vector<double> &columns) const
  {
    const std::size_t n = free_dofs.size(), n_strained = task.examples.n;
    columns.assign(n * examples->n_strained_weights(), 0.);
    dealii::AlignedVector<double> forces(12 * batch_size * n_strained);
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      const std::size_t lane = cell % batch_size;
      if (lane == 0)
        kernels.coupling(task, tangent, rotated, cell / batch_size, forces.data());
      int dof[12];
      for (unsigned int p = 0; p < 12; ++p)
        dof[p] = free_dofs.free_index(3 * batches.node(cell, p / 3) + p % 3);
      examples->for_each_weight(
          cell,
          [&](const unsigned int weight, const unsigned int i, const double share)
          {
            double       *column = columns.data() + n * examples->strained_index(weight);
            const double *force  = &forces[12 * batch_size * (i - task.examples.first) + lane];
            for (unsigned int p = 0; p < 12; ++p)
              if (dof[p] != FreeDofs::held)
                column[dof[p]] += share * force[p * batch_size];
          });
    }
  }

  void
  Assembler::add_rotated_responses(const dealii::Vector<double> &displacement,
                                   Evaluation                   &result) const
  {
    for (const unsigned int cell : cells_beside_held_nodes)
    {
      const Matrix3<double> dF = fe_space.deformation_gradient(cell, displacement);
      const Matrix3<double> de = symmetric_part(transpose_times(batches.rotation(cell), dF));
      add_force(cell, stress(damped_lame(cell), de), result.gradient);
      if (!result.weight_gradient.empty())
      {
        const Matrix3<double> dT     = stress(material.elasticity(cell), de);
        const double          factor = examples->importance() * fe_space.tetrahedron(cell).volume;
        examples->for_each_weight(
            cell,
            [&](const unsigned int weight, const unsigned int i, const double share) {
              result.weight_gradient[weight]
                  -= share * factor * contract(dT, examples->strain(cell, i));
            });
      }
    }
  }

  template <typename Cell>
  Cell
  Assembler::cell_state(const Tangent                 tangent,
                        const unsigned int            cell,
                        const dealii::Vector<double> &positions,
                        const std::vector<double>    &weights) const
  {
    Cell state(damped_lame(cell), batches.rotation(cell),
               fe_space.deformation_gradient(cell, positions), guard_bound);
    state.set_target(damped_target(cell, example_target(cell, weights)));
    if constexpr (std::is_same_v<Cell, GreenCell<double>>) // the others' is R K R^T
      if (tangent == Tangent::convex)
        state.make_convex();
    return state;
  }

  void
  Assembler::assemble_tangent(const Tangent                 tangent,
                              const dealii::Vector<double> &positions,
                              const std::vector<double>    &weights,
                              std::vector<double>          &matrix_values,
                              std::vector<double>          &columns)
  {
    start_matrix(matrix_values);
    const bool rotated = is_rotated_stiffness(tangent);
    CellTask   cells   = task(positions, weights, RotationUse::keep);
    // what is convex anyway need not know which cells the damping leaves out, and a resumed run
    // does not know which these were when the factor was made
    dealii::AlignedVector<double> whole_damping;
    if (tangent == Tangent::convex && damping > 0.)
    {
      whole_damping.resize(cell_damping.size(), damping);
      cells.damping.factors = whole_damping.data();
    }
    const TangentTask to
        = { tangent == Tangent::convex, block_positions.data(), matrix_values.data() };
    (rotated ? kernels.add_rotated_stiffness : kernels.add_tangent)(cells, to, 0,
                                                                    cells.cells.n_batches());
    add_mixed_cells(cells, to, rotated);
    if (has_weights())
      assemble_coupling(cells, to, rotated, columns);
  }

  template <typename Cell>
  void
  Assembler::add_cell_responses(const Tangent                 tangent,
                                const dealii::Vector<double> &displacement,
                                const dealii::Vector<double> &positions,
                                const std::vector<double>    &weights,
                                Evaluation                   &result) const
  {
    for (const unsigned int cell : cells_beside_held_nodes)
    {
      const Cell            state = cell_state<Cell>(tangent, cell, positions, weights);
      const Matrix3<double> M     = transpose_times(batches.rotation(cell),
                                                    fe_space.deformation_gradient(cell, displacement));
      add_force(cell, state.response(M), result.gradient);
      if (result.weight_gradient.empty())
        continue;
      const double factor
          = examples->importance() / (1. + damping_of(cell)) * fe_space.tetrahedron(cell).volume;
      examples->for_each_weight(
          cell,
          [&](const unsigned int weight, const unsigned int i, const double share)
          {
            result.weight_gradient[weight]
                -= share * factor * contract(state.example_response(examples->strain(cell, i)), M);
          });
    }
  }

  void
  Assembler::add_response_beside_held_nodes(const Tangent                 tangent,
                                            const dealii::Vector<double> &displacement,
                                            const dealii::Vector<double> &positions,
                                            const std::vector<double>    &weights,
                                            Evaluation                   &result)
  {
    refresh_rotations();
    if (is_rotated_stiffness(tangent))
      add_rotated_responses(displacement, result);
    else if (model.strain == StrainMeasure::green)
      add_cell_responses<GreenCell<double>>(tangent, displacement, positions, weights, result);
    else
      add_cell_responses<CorotationalCell<double>>(tangent, displacement, positions, weights,
                                                   result);
  }
} // namespace Exemplar
