// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/assembler.h>
#include <exemplar/corotational_consistent.h>

// The parts of the assembler that Newton's method needs: the exact tangent.

namespace Exemplar
{
  namespace
  {
    using Cell = ConsistentCell<double>;

    /// R^T dP for the nine unit changes of R^T dF, Eq. (18).
    struct CellTangent
    {
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
  } // namespace

  void
  Assembler::assemble_exact(const dealii::Vector<double> &positions,
                            const std::vector<double>    &weights,
                            std::vector<double>          &matrix_values,
                            std::vector<double>          &columns) const
  {
    const bool with_columns = examples != nullptr && !examples->weights_are_prescribed();
    start_matrix(matrix_values);
    if (with_columns)
      columns.assign(static_cast<std::size_t>(free_dofs.size()) * examples->size(), 0.);
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      const Tetrahedron<double> &tet   = fe_space.tetrahedron(cell);
      const Matrix3<double>     &R     = rotations[cell];
      const Cell                 state = cell_state(cell, positions, weights);
      const CellTangent          tangent(state);
      CellMatrix                 cell_matrix;
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int b = 0; b <= a; ++b)
        {
          const Matrix3<double> block
              = turned(R, tangent.block(tet.shape_gradient[a], tet.shape_gradient[b]), tet.volume);
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int j = 0; j < 3; ++j)
              cell_matrix[3 * a + i][3 * b + j] = block[i][j];
        }
      add_cell_matrix(cell, cell_matrix, matrix_values);
      if (with_columns)
        for (unsigned int i = examples->first_strained_example(); i < examples->size(); ++i)
        {
          Vector3<double> force[4];
          frozen_forces(tet, R, state.example_response(examples->strain(cell, i)), force);
          add_to_column(cell, force, i, columns);
        }
    }
  }

  void
  Assembler::add_exact_response(const dealii::Vector<double> &displacement,
                                const dealii::Vector<double> &positions,
                                const std::vector<double>    &weights,
                                Evaluation                   &result) const
  {
    for (const unsigned int cell : cells_beside_held_nodes)
    {
      const Tetrahedron<double> &tet   = fe_space.tetrahedron(cell);
      const Cell                 state = cell_state(cell, positions, weights);
      const Matrix3<double>      M
          = transpose_times(rotations[cell], fe_space.deformation_gradient(cell, displacement));
      Vector3<double> force[4];
      frozen_forces(tet, rotations[cell], state.response(M), force);
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int c = 0; c < 3; ++c)
          result.gradient[3 * fe_space.nodes(cell)[a] + c] += force[a][c];
      for (unsigned int i = examples != nullptr ? examples->first_strained_example() : 0;
           i < result.weight_gradient.size(); ++i)
        result.weight_gradient[i]
            -= examples->importance() * tet.volume
               * contract(state.example_response(examples->strain(cell, i)), M);
    }
  }

  std::vector<double>
  Assembler::weight_target(const dealii::Vector<double> &positions) const
  {
    std::vector<double> c(examples->size(), 0.);
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      const Cell            state(material.lame(cell), rotations[cell],
                                  fe_space.deformation_gradient(cell, positions), examples->guard_bound());
      const Matrix3<double> stress = state.weight_stress(identity_matrix<double>());
      for (unsigned int i = examples->first_strained_example(); i < examples->size(); ++i)
        c[i] += examples->importance() * fe_space.tetrahedron(cell).volume
                * contract(stress, examples->strain(cell, i));
    }
    return c;
  }

  ConsistentCell<double>
  Assembler::cell_state(const unsigned int            cell,
                        const dealii::Vector<double> &positions,
                        const std::vector<double>    &weights) const
  {
    Cell state(material.lame(cell), rotations[cell], fe_space.deformation_gradient(cell, positions),
               examples != nullptr ? examples->guard_bound() : default_guard_bound);
    Matrix3<double> target = identity_matrix<double>();
    if (examples != nullptr)
      target = combine(1., target, examples->importance(), examples->strain(cell, weights));
    state.set_target(target);
    return state;
  }
} // namespace Exemplar
