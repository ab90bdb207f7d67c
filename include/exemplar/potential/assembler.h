// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_assembler_h
#define exemplar_assembler_h

#include <exemplar/algebra/free_dofs.h>
#include <exemplar/algebra/spd_operator.h>
#include <exemplar/body/cell_batches.h>
#include <exemplar/body/example_poses.h>
#include <exemplar/body/fe_space.h>
#include <exemplar/body/material.h>
#include <exemplar/body/model_parameters.h>
#include <exemplar/potential/inertia.h>

#include <deal.II/lac/vector.h>

#include <array>
#include <vector>

namespace Exemplar
{
  /// The matrix with which a step is solved.
  enum class Tangent
  {
    exact, ///< the derivative of the gradient, Eq. (18)
    convex ///< never indefinite, together with the weights: R K R^T, Eq. (8), or its counterpart
  };

  /// Everything that a loop over the cells finds at given positions and weights.
  struct Evaluation
  {
    dealii::Vector<double> gradient;           ///< internal forces dPsi/dx [N], Eq. (6)
    dealii::Vector<double> force_scale;        ///< a node: sum V (|C:e| + eta |C:E(w)|) |g_a| [N]
    std::vector<double>    weight_gradient;    ///< dPsi/dw_i [J], Eq. (7)
    double                 weight_scale   = 0; ///< of the weight gradient [J]
    double                 energy         = 0; ///< Psi [J], Eq. (5), ridge included
    double                 energy_elastic = 0; ///< sum V/2 e:C:e of it [J]
    double                 energy_damping = 0; ///< whose gradient is the stiffness damping [J]
    double                 min_det_F      = 0;
    unsigned int           inverted_cells = 0;
    unsigned int           guarded_cells  = 0; ///< in which the guard of Eq. (16) acts

    /// Psi - energy_elastic [J]; near an example the two almost cancel.
    double
    energy_example() const
    {
      return energy - energy_elastic;
    }
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

    /// R of every cell from the polar decomposition at these positions. Models other
    /// than the corotational have none: theirs stay I.
    void
    update_rotations(const dealii::Vector<double> &positions);

    /// About the rotation of each node, the mean of its cells': nine numbers a node, by rows.
    void
    node_rotations(std::vector<float> &rotations);

    /// From now on forces contain the stiffness damping s C:(e - sum_m c_m e(x_m)), with
    /// s [-] the damping time over the time step. s = 0: none. Cells that the guard of
    /// Eq. (16) had to hold at one of the x_m are left out: their rotation is ambiguous.
    void
    set_damping(double s, const std::vector<WeightedPositions> &history);

    /// Energies and their derivatives. Who has the weight_target() of these positions spares
    /// the loop those by the weights.
    void
    evaluate(const dealii::Vector<double> &positions,
             const std::vector<double>    &weights,
             Evaluation                   &evaluation,
             Rotations                     rotations     = Rotations::keep,
             const std::vector<double>    *weight_target = nullptr);

    /// A, Eq. (8) or (18), into the values on matrix_pattern() [N/m] and, with weights to
    /// find, the coupling G, Eq. (9): a column a strained weight on the free degrees of
    /// freedom, one after the other [N]. An exact tangent needs the rotations of these positions.
    void
    assemble_tangent(Tangent                       tangent,
                     const dealii::Vector<double> &positions,
                     const std::vector<double>    &weights,
                     std::vector<double>          &matrix_values,
                     std::vector<double>          &columns);

    /// What `displacement` [m] from `positions`, zero but on held degrees of freedom, adds
    /// to the forces and to the weight gradient by that tangent.
    void
    add_response_beside_held_nodes(Tangent                       tangent,
                                   const dealii::Vector<double> &displacement,
                                   const dealii::Vector<double> &positions,
                                   const std::vector<double>    &weights,
                                   Evaluation                   &evaluation);

    /// c_i with dPsi/dw = H w - c at these positions [J].
    std::vector<double>
    weight_target(const dealii::Vector<double> &positions, Rotations rotations = Rotations::keep);

    /// A residual force [N] that is nothing but the rounding of the positions.
    double
    rounding_force() const
    {
      // both strains that damping compares have rounding of their own, the decomposition's, too
      return (1. + 8. * damping) * greatest_rounding_force;
    }

    /// The same for the derivative of the energy by a weight [J].
    double
    rounding_weight_gradient(unsigned int weight) const;

    CellResults
    cell_results(const dealii::Vector<double> &positions, const std::vector<double> &weights);

    /// Of the cells, their forces and the pattern of A, in bytes.
    std::size_t
    memory_consumption() const;

  private:
    bool
    has_weights() const
    {
      return examples != nullptr && !examples->weights_are_prescribed();
    }

    /// Whether a tangent is R K R^T: always with the linear strain, whose exact one it is.
    bool
    is_rotated_stiffness(const Tangent tangent) const
    {
      return model.strain == StrainMeasure::linear
             || (model.strain == StrainMeasure::corotational && tangent == Tangent::convex);
    }

    /// eta E(w) in a cell; 0 without examples.
    Matrix3<double>
    example_target(unsigned int cell, const std::vector<double> &weights) const;

    /// The elastic constants and the target strain of a cell with the damping added: both
    /// are quadratics around a strain, and so is their sum.
    Lame<double>
    damped_lame(unsigned int cell) const;

    /// s of set_damping(), 0 where it is left out.
    double
    damping_of(const unsigned int cell) const
    {
      return cell_damping.empty() ? 0. : cell_damping[cell];
    }

    Matrix3<double>
    damped_target(unsigned int cell, const Matrix3<double> &target) const;

    Matrix3<double>
    damping_strain(const unsigned int cell) const
    {
      double E[6];
      for (unsigned int k = 0; k < 6; ++k)
        E[k] = damping_strains[batch_index(cell, 6, k)];
      return { { { E[0], E[5], E[4] }, { E[5], E[1], E[3] }, { E[4], E[3], E[2] } } };
    }

    CellTask
    task(const dealii::Vector<double> &positions,
         const std::vector<double>    &weights,
         Rotations                     rotations);

    /// Find the rotations that the last loop has forgotten.
    void
    refresh_rotations();

    /// Sums of the cells' forces at the nodes.
    void
    gather_forces(Evaluation &result) const;

    void
    add_penalty(const std::vector<double> &weights, double stress_norm, Evaluation &result) const;

    /// A cell as it is driven, its target set.
    template <typename Cell>
    Cell
    cell_state(Tangent                       tangent,
               unsigned int                  cell,
               const dealii::Vector<double> &positions,
               const std::vector<double>    &weights) const;

    void
    add_mixed_cells(const CellTask &task, TangentTask tangent, bool rotated);

    void
    assemble_coupling(const CellTask      &task,
                      const TangentTask   &tangent,
                      bool                 rotated,
                      std::vector<double> &columns) const;

    template <typename Cell>
    void
    add_cell_responses(Tangent                       tangent,
                       const dealii::Vector<double> &displacement,
                       const dealii::Vector<double> &positions,
                       const std::vector<double>    &weights,
                       Evaluation                   &result) const;

    void
    add_rotated_responses(const dealii::Vector<double> &displacement, Evaluation &result) const;

    /// Into the gradient: nodal forces of a change of R^T P.
    void
    add_force(unsigned int cell, const Matrix3<double> &dP, dealii::Vector<double> &gradient) const
    {
      Vector3<double> force[4];
      frozen_forces(fe_space.tetrahedron(cell), batches.rotation(cell), dP, force);
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int c = 0; c < 3; ++c)
          gradient[3 * fe_space.nodes(cell)[a] + c] += force[a][c];
    }

    void
    start_matrix(std::vector<double> &matrix_values) const;

    void
    build_pattern();

    void
    build_block_positions();

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
    const double          guard_bound; ///< p_0 of Eq. (16)

    const CellKernels &kernels;

    CellBatches           batches;
    const std::size_t     n_stripes;
    SymmetricPattern      pattern;
    std::vector<int>      block_positions; ///< of TangentTask
    std::vector<unsigned> mixed_cells;     ///< with a node of which only some components are held
    std::vector<unsigned> cells_beside_held_nodes;
    dealii::AlignedVector<float>  rotation_sums;
    dealii::AlignedVector<double> node_positions; ///< of the last loop, as the kernels want them
    bool                          rotations_are_forgotten = false; ///< those of node_positions
    dealii::AlignedVector<double> nodal_sums;   ///< of forces and scales, stripe by stripe
    std::vector<double>           mass_values;  ///< M on the pattern; empty in statics
    double                        damping = 0.; ///< s of set_damping()
    dealii::AlignedVector<double> cell_damping; ///< in batches; empty without damping
    dealii::AlignedVector<double> damping_strains;
    double                        greatest_rounding_force = 0.;
    double                        rounding_stress_norm    = 0.; ///< (sum V T^2)^(1/2)
  };
} // namespace Exemplar

#endif
