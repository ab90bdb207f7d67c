// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_assembler_h
#define exemplar_assembler_h

#include <exemplar/corotational_consistent.h>
#include <exemplar/example_poses.h>
#include <exemplar/fe_space.h>
#include <exemplar/free_dofs.h>
#include <exemplar/inertia.h>
#include <exemplar/material.h>
#include <exemplar/spd_operator.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/lac/vector.h>

#include <array>
#include <vector>

namespace Exemplar
{
  enum class StrainMeasure
  {
    corotational
  };

  enum class GradientKind
  {
    consistent,
    frozen
  };

  /// Subsection Model.
  struct ModelParameters
  {
    StrainMeasure strain   = StrainMeasure::corotational;
    GradientKind  gradient = GradientKind::consistent;

    void
    declare(dealii::ParameterHandler &prm);
  };

  /// Everything that a loop over the cells finds at given positions and weights.
  struct Evaluation
  {
    dealii::Vector<double> gradient;           ///< internal forces dPsi/dx [N], Eq. (6)
    dealii::Vector<double> force_scale;        ///< a node: sum V (|C:e| + eta |C:E(w)|) |g_a| [N]
    std::vector<double>    weight_gradient;    ///< dPsi/dw_i [J], Eq. (7)
    double                 weight_scale   = 0; ///< of the weight gradient [J]
    double                 energy_elastic = 0; ///< sum V/2 e:C:e [J], Eq. (5)
    double                 energy_example = 0; ///< Psi - energy_elastic, ridge included [J]
    double                 min_det_F      = 0;
    unsigned int           inverted_cells = 0;
    unsigned int           guarded_cells  = 0; ///< in which the guard of Eq. (16) acts
  };

  /// What frames show of a cell.
  struct CellResults
  {
    std::vector<double> strain_energy_density; ///< 1/2 e:C:e [J/m^3]
    std::vector<double> det_F;
    std::vector<double> von_mises_stress; ///< of the corotated stress C:(e - eta E(w)) [Pa]
  };

  /// Loops over the cells: rotations, energies, forces, the matrix A and the columns
  /// G of Eq. (10). Rotations are kept ("frozen") until update_rotations().
  class Assembler
  {
  public:
    /// `examples` and `inertia` may be null: the scene has none.
    Assembler(const ModelParameters &model,
              const FESpace         &fe_space,
              const Material        &material,
              const ExamplePoses    *examples,
              const Inertia         *inertia,
              const FreeDofs        &free_dofs);

    /// Pattern of A on the free degrees of freedom.
    const SymmetricPattern &
    matrix_pattern() const
    {
      return pattern;
    }

    /// R of every cell from the polar decomposition at these positions.
    void
    update_rotations(const dealii::Vector<double> &positions);

    /// Energies and their derivatives with the rotations as they are.
    void
    evaluate(const dealii::Vector<double> &positions,
             const std::vector<double>    &weights,
             Evaluation                   &evaluation) const;

    /// What `displacement` [m], zero but on held degrees of freedom, adds to the forces
    /// and to the weight gradient while the rotations are as they are.
    void
    add_response_beside_held_nodes(const dealii::Vector<double> &displacement,
                                   Evaluation                   &evaluation) const;

    /// A = [M/h^2] + sum R K R^T, Eq. (8), into the values on matrix_pattern() [N/m].
    void
    assemble_matrix(std::vector<double> &matrix_values) const;

    /// G_i = eta sum R K q_i, Eq. (9), on the free degrees of freedom: one column an
    /// example, one after the other [N].
    void
    assemble_coupling(std::vector<double> &columns) const;

    /// The exact tangent of the consistent forces, Eq. (18), into the matrix and, with
    /// weights to find, the coupling; where the rotations are those of `positions`.
    void
    assemble_exact(const dealii::Vector<double> &positions,
                   const std::vector<double>    &weights,
                   std::vector<double>          &matrix_values,
                   std::vector<double>          &columns) const;

    /// What add_response_beside_held_nodes() adds, with the exact tangent.
    void
    add_exact_response(const dealii::Vector<double> &displacement,
                       const dealii::Vector<double> &positions,
                       const std::vector<double>    &weights,
                       Evaluation                   &evaluation) const;

    /// c_i with dPsi/dw = H w - c at these positions [J]; the rotations are theirs.
    std::vector<double>
    weight_target(const dealii::Vector<double> &positions) const;

    /// A residual force [N] that is nothing but rounding: strains of 1e-14 would cause
    /// as much.
    double
    rounding_force() const
    {
      return greatest_rounding_force;
    }

    /// The same for the derivative of the energy by the weight of example i [J].
    double
    rounding_weight_gradient(unsigned int i) const;

    CellResults
    cell_results(const dealii::Vector<double> &positions, const std::vector<double> &weights) const;

  private:
    /// Entries of the lower triangle of a cell's 12x12 matrix, by rows.
    static constexpr unsigned int n_cell_entries = 12 * 13 / 2;

    using CellMatrix = double[12][12];

    ConsistentCell<double>
    cell_state(unsigned int                  cell,
               const dealii::Vector<double> &positions,
               const std::vector<double>    &weights) const;

    void
    start_matrix(std::vector<double> &matrix_values) const;

    void
    add_cell_matrix(const unsigned int   cell,
                    const CellMatrix    &cell_matrix,
                    std::vector<double> &matrix_values) const
    {
      unsigned int entry = 0;
      for (unsigned int p = 0; p < 12; ++p)
        for (unsigned int q = 0; q <= p; ++q, ++entry)
          if (const int position = scatter[cell][entry]; position != FreeDofs::held)
            matrix_values[position] += cell_matrix[p][q];
    }

    void
    add_to_column(const unsigned int cell,
                  const Vector3<double> (&force)[4],
                  const unsigned int   example,
                  std::vector<double> &columns) const
    {
      double *column = columns.data() + static_cast<std::size_t>(example) * free_dofs.size();
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int c = 0; c < 3; ++c)
          if (const int dof = free_dofs.free_index(3 * fe_space.nodes(cell)[a] + c);
              dof != FreeDofs::held)
            column[dof] += examples->importance() * force[a][c];
    }

    void
    build_pattern();

    void
    build_scatter();

    void
    build_mass_values();

    void
    estimate_rounding();

    const ModelParameters model;
    const FESpace        &fe_space;
    const Material       &material;
    const ExamplePoses   *examples;
    const Inertia        *inertia;
    const FreeDofs       &free_dofs;

    SymmetricPattern pattern;
    std::vector<std::array<int, n_cell_entries>>
                                       scatter; ///< where each entry goes, or FreeDofs::held
    std::vector<unsigned int>          cells_beside_held_nodes;
    std::vector<double>                mass_values;    ///< M on the pattern; empty in statics
    std::vector<std::array<double, 4>> gradient_norms; ///< |g_a|
    std::vector<Matrix3<double>>       rotations;
    double                             greatest_rounding_force = 0.;
    double                             rounding_stress_norm    = 0.; ///< (sum V T^2)^(1/2)
  };
} // namespace Exemplar

#endif
