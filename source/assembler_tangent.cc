// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/assembler.h>
#include <exemplar/hot_loop.h>

#include <algorithm>
#include <type_traits>

// The matrix A and the columns G of a step: R K R^T, for which four vectors are turned and
// no matrix is multiplied, and the tangents of the models.

namespace Exemplar
{
  namespace
  {
    /// R^T dP for the nine unit changes of R^T dF.
    struct CellTangent
    {
      template <typename Cell>
      explicit CellTangent(const Cell &cell)
      {
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l < 3; ++l)
          {
            Matrix3<double> unit{};
            unit[k][l]   = 1.;
            column[k][l] = cell.response(unit);
          }
      }

      /// Block (a,b) of the cell's matrix in the frame of the rotation.
      Matrix3<double>
      block(const Vector3<double> &g_a, const Vector3<double> &g_b) const
      {
        Matrix3<double> result{};
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l < 3; ++l)
          {
            const Vector3<double> force = column[k][l] * g_a;
            for (int i = 0; i < 3; ++i)
              result[i][k] += g_b[l] * force[i];
          }
        return result;
      }

      Matrix3<double> column[3][3];
    };

    /// V R B R^T.
    Matrix3<double>
    turned(const Matrix3<double> &R, const Matrix3<double> &B, const double volume)
    {
      const Matrix3<double> RB = R * B;
      Matrix3<double>       result;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          result[i][j] = volume * (RB[i][0] * R[j][0] + RB[i][1] * R[j][1] + RB[i][2] * R[j][2]);
      return result;
    }

    template <typename CellMatrix>
    void
    set_block(const unsigned int     a,
              const unsigned int     b,
              const Matrix3<double> &block,
              CellMatrix            &matrix)
    {
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          matrix[3 * a + i][3 * b + j] = block[i][j];
    }
  } // namespace

  void
  Assembler::start_matrix(std::vector<double> &matrix_values) const
  {
    if (inertia == nullptr)
      std::fill(matrix_values.begin(), matrix_values.end(), 0.);
    else
      for (std::size_t i = 0; i < matrix_values.size(); ++i)
        matrix_values[i] = inertia->matrix_factor() * mass_values[i];
  }

  EXEMPLAR_HOT_LOOP void
  Assembler::assemble_rotated_stiffness(std::vector<double> &matrix_values) const
  {
    start_matrix(matrix_values);
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      const Tetrahedron<double> &tet  = fe_space.tetrahedron(cell);
      const Lame<double>         lame = damped_lame(cell);
      Vector3<double>            g[4];
      rotate_gradients(tet, rotations[cell], g);
      CellMatrix cell_matrix;
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int b = 0; b <= a; ++b)
          set_block(a, b, stiffness_block(lame, tet.volume, g[a], g[b]), cell_matrix);
      add_cell_matrix(cell, cell_matrix, matrix_values);
    }
  }

  EXEMPLAR_HOT_LOOP void
  Assembler::assemble_rotated_coupling(std::vector<double> &columns) const
  {
    start_columns(columns);
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      examples->for_each_weight(
          cell,
          [&](const unsigned int weight, const unsigned int i, const double share)
          {
            const Matrix3<double> T = stress(material.lame(cell), examples->strain(cell, i));
            Vector3<double>       force[4];
            frozen_forces(fe_space.tetrahedron(cell), rotations[cell], T, force);
            add_to_column(cell, force, weight, share * examples->importance(), columns);
          });
  }

  void
  Assembler::add_rotated_responses(const dealii::Vector<double> &displacement,
                                   Evaluation                   &result) const
  {
    for (const unsigned int cell : cells_beside_held_nodes)
    {
      const Matrix3<double> dF = fe_space.deformation_gradient(cell, displacement);
      const Matrix3<double> de = symmetric_part(transpose_times(rotations[cell], dF));
      add_force(cell, stress(damped_lame(cell), de), result.gradient);
      if (!result.weight_gradient.empty())
      {
        const Matrix3<double> dT     = stress(material.lame(cell), de);
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
    Cell state(damped_lame(cell), rotations[cell], fe_space.deformation_gradient(cell, positions),
               guard_bound);
    state.set_target(damped_target(cell, example_target(cell, weights)));
    if constexpr (std::is_same_v<Cell, GreenCell<double>>) // the others' is R K R^T
      if (tangent == Tangent::convex)
        state.make_convex();
    return state;
  }

  template <typename Cell>
  void
  Assembler::assemble_cells(const Tangent                 tangent,
                            const dealii::Vector<double> &positions,
                            const std::vector<double>    &weights,
                            std::vector<double>          &matrix_values,
                            std::vector<double>          &columns) const
  {
    start_matrix(matrix_values);
    if (has_weights())
      start_columns(columns);
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      const Tetrahedron<double> &tet   = fe_space.tetrahedron(cell);
      const Matrix3<double>     &R     = rotations[cell];
      const Cell                 state = cell_state<Cell>(tangent, cell, positions, weights);
      const CellTangent          response(state);
      CellMatrix                 cell_matrix;
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int b = 0; b <= a; ++b)
          set_block(
              a, b,
              turned(R, response.block(tet.shape_gradient[a], tet.shape_gradient[b]), tet.volume),
              cell_matrix);
      add_cell_matrix(cell, cell_matrix, matrix_values);
      if (!has_weights())
        continue;
      // the target moves by 1/(1+s) of what the examples' does
      const double factor = examples->importance() / (1. + damping_of(cell));
      examples->for_each_weight(
          cell,
          [&](const unsigned int weight, const unsigned int i, const double share)
          {
            Vector3<double> force[4];
            frozen_forces(tet, R, state.example_response(examples->strain(cell, i)), force);
            add_to_column(cell, force, weight, share * factor, columns);
          });
    }
  }

  void
  Assembler::assemble_tangent(const Tangent                 tangent,
                              const dealii::Vector<double> &positions,
                              const std::vector<double>    &weights,
                              std::vector<double>          &matrix_values,
                              std::vector<double>          &columns) const
  {
    if (is_rotated_stiffness(tangent))
    {
      assemble_rotated_stiffness(matrix_values);
      if (has_weights())
        assemble_rotated_coupling(columns);
    }
    else if (model.strain == StrainMeasure::green)
      assemble_cells<GreenCell<double>>(tangent, positions, weights, matrix_values, columns);
    else
      assemble_cells<CorotationalCell<double>>(tangent, positions, weights, matrix_values, columns);
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
      const Matrix3<double> M
          = transpose_times(rotations[cell], fe_space.deformation_gradient(cell, displacement));
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
                                            Evaluation                   &result) const
  {
    if (is_rotated_stiffness(tangent))
      add_rotated_responses(displacement, result);
    else if (model.strain == StrainMeasure::green)
      add_cell_responses<GreenCell<double>>(tangent, displacement, positions, weights, result);
    else
      add_cell_responses<CorotationalCell<double>>(tangent, displacement, positions, weights,
                                                   result);
  }
} // namespace Exemplar
