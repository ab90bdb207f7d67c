// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_turned_factor_h
#define exemplar_turned_factor_h

#include <exemplar/algebra/bordered_solver.h>
#include <exemplar/algebra/free_dofs.h>
#include <exemplar/algebra/single_precision_factor.h>

#include <vector>

namespace Exemplar
{
  /// The factor of an earlier tangent as an approximate inverse of the present one: in single
  /// precision, and turned with the nodes, W P^-1 W^T with W the rotation of each node since
  /// then. With weights to find it also tells how they follow, by the Schur complement of
  /// Eq. (23).
  class TurnedFactor
  {
  public:
    explicit TurnedFactor(const FreeDofs &free_dofs);

    /// Take over the factor of a matrix that was just factorised.
    /// `rotations` are those of the nodes then, nine numbers a node by rows.
    void
    reinit(SpdOperator &matrix, const WeightBlock &block, const std::vector<float> &rotations);

    /// H - G^T Z; empty without weights to find.
    const dealii::FullMatrix<double> &
    schur_complement() const
    {
      return schur;
    }

    /// From now on the nodes are turned by these rotations.
    void
    turn(const std::vector<float> &rotations);

    /// Into the frame of the factor, W^T; by free degree of freedom.
    void
    turn_back(std::vector<double> &vector) const
    {
      multiply_by_turns(vector, 1, 3);
    }

    /// Out of it, W.
    void
    turn_forth(std::vector<double> &vector) const
    {
      multiply_by_turns(vector, 3, 1);
    }

    /// What the weights will do if the forces, in the frame of the factor, act on the body:
    /// from where the energy has `weight_gradient`, with changes not below `lower` (empty: no
    /// bounds).
    std::vector<double>
    find_weight_changes(const std::vector<double> &forces,
                        const std::vector<double> &weight_gradient,
                        const std::vector<double> &lower) const;

    /// Add the forces G w that go with changes of the weights.
    void
    add_example_forces(const std::vector<double> &weights, std::vector<double> &forces) const;

    /// Overwrite forces by the displacement that they cause at fixed weights, both in the
    /// frame of the factor.
    void
    solve(std::vector<double> &vector);

    /// What a factorisation costs over an iteration with solve(): from counts of operations
    /// and the rates of doc/results.md, never from a clock.
    double
    cost_over_solve() const
    {
      return relative_cost;
    }

    void
    clear()
    {
      factor = SinglePrecisionFactor();
    }

    bool
    empty() const
    {
      return factor.empty();
    }

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    void
    find_turned_nodes();

    /// With W stored by rows, `row` and `column` are the strides of its indices.
    void
    multiply_by_turns(std::vector<double> &vector, int row, int column) const;

    const FreeDofs            &free_dofs;
    std::vector<unsigned int>  turned_nodes; ///< of which all components are free
    SinglePrecisionFactor      factor;
    std::vector<float>         rotations_then;
    std::vector<float>         turns; ///< nine numbers a turned node
    std::vector<unsigned int>  coupled;
    std::vector<float>         G, Z;  ///< Z = A^-1 G, as the block's columns
    dealii::FullMatrix<double> schur; ///< H - G^T Z
    dealii::FullMatrix<double> sums;  ///< N
    std::vector<float>         right_side;
    double                     relative_cost = 0.;
  };
} // namespace Exemplar

#endif
