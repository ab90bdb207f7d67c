// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_rotated_metric_h
#define exemplar_rotated_metric_h

#include <exemplar/algebra/bordered_system.h>
#include <exemplar/algebra/free_dofs.h>

#include <memory>
#include <vector>

namespace Exemplar
{
  /// The inverse of an earlier tangent as an approximate inverse of the present one, Eq. (23): it
  /// is kept, and rotated with the nodes, Q P^-1 Q^T with Q the rotation of each node since then.
  /// With weights to find it also tells how they follow, by their Schur complement. Vectors are by
  /// free degree of freedom.
  class RotatedMetric
  {
  public:
    explicit RotatedMetric(const FreeDofs &free_dofs);

    /// Take over the tangent of a system that was factorised last. `inverse_columns` are its inverse times the columns
    /// of its weights; `rotations` are those of the nodes where it was assembled, nine numbers a node by rows. Throws
    /// SolverFailure if the system keeps no inverse.
    void
    reinit(const BorderedSystem      &system,
           const std::vector<double> &inverse_columns,
           const std::vector<float>  &rotations);

    /// H - G^T Z; empty without weights to find.
    const dealii::FullMatrix<double> &
    schur_complement() const
    {
      return schur;
    }

    /// From now on the nodes are rotated by these rotations.
    void
    rotate(const std::vector<float> &rotations);

    /// Into the frame of the kept inverse, Q^T.
    void
    rotate_back(std::vector<double> &vector) const
    {
      multiply_by_rotations(vector, 1, 3);
    }

    /// Out of it, Q.
    void
    rotate_forth(std::vector<double> &vector) const
    {
      multiply_by_rotations(vector, 3, 1);
    }

    /// A vector at one node into the frame of the kept inverse.
    dealii::Tensor<1, 3>
    rotate_back(unsigned int node, const dealii::Tensor<1, 3> &vector) const;

    /// What the weights will do if these forces, in the frame of the kept inverse, act on the body:
    /// from where the energy has `weight_gradient`, with changes as these limits leave them.
    std::vector<double>
    find_weight_changes(const std::vector<double> &forces,
                        const std::vector<double> &weight_gradient,
                        const WeightLimits        &limits) const;

    /// Add the forces G w that go with changes of the weights.
    void
    add_example_forces(const std::vector<double> &weights, std::vector<double> &forces) const;

    /// Add the displacements Z w that these forces cause.
    void
    add_example_responses(const std::vector<double> &weights, std::vector<double> &step) const;

    /// Overwrite forces by the displacement that they cause at fixed weights, both in the
    /// frame of the kept inverse.
    void
    apply(std::vector<double> &vector)
    {
      inverse->apply(vector);
    }

    /// As KeptInverse::entries().
    std::unique_ptr<InverseEntries>
    entries() const
    {
      return inverse->entries();
    }

    /// Number of calls of reinit(), by which who has entries() notices that there are others.
    unsigned int
    version() const
    {
      return n_reinits;
    }

    /// As KeptInverse::cost_in_iterations().
    double
    cost_in_iterations() const
    {
      return inverse->cost_in_iterations(form->coupled.size());
    }

    void
    clear()
    {
      inverse.reset();
    }

    bool
    empty() const
    {
      return inverse == nullptr;
    }

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    void
    find_rotated_nodes();

    /// With Q stored by rows, `row` and `column` are the strides of its indices.
    void
    multiply_by_rotations(std::vector<double> &vector, int row, int column) const;

    const FreeDofs              &free_dofs;
    std::vector<unsigned int>    rotated_nodes; ///< of which all components are free
    std::unique_ptr<KeptInverse> inverse;
    std::vector<float>           rotations_then;
    std::vector<float>           rotations_since; ///< Q, nine numbers a rotated node
    unsigned int                 n_reinits = 0;
    const WeightForm            *form      = nullptr; ///< of the system that the inverse is of
    std::vector<float>           G, Z;  ///< columns of the coupled weights; Z = A^-1 G
    dealii::FullMatrix<double>   schur; ///< H - G^T Z
  };
} // namespace Exemplar

#endif
