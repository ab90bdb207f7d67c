// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_field_h
#define exemplar_cell_field_h

#include <exemplar/algebra/vector.h>
#include <exemplar/body/cell_batches.h>
#include <exemplar/body/fe_space.h>
#include <exemplar/body/material.h>
#include <exemplar/kernels/cell_kernels.h>

#include <deal.II/base/aligned_vector.h>

#include <vector>

namespace Exemplar
{
  /// The quadrature points of the cells as the loops of kernels/ see them, with the rotation at
  /// each, and the positions of the last loop. Rotations stay as they are ("frozen") until a loop
  /// updates them.
  class CellField
  {
  public:
    /// `guard_bound` is p_0 of Eq. (16); `has_patches` as CellBatches has it.
    CellField(CellLaw         law,
              double          guard_bound,
              const FESpace  &fe_space,
              const Material &material,
              bool            has_patches);

    /// The input of a loop over these cells at these positions, by degree of freedom [m]. It refers
    /// to arrays of this object.
    CellTask
    task(const Vector &positions, RotationUse rotations);

    /// R at every point from the polar decomposition at these positions. Models without rotations
    /// keep I.
    void
    update_rotations(const Vector &positions);

    /// Find the rotations that the last loop has found and forgotten, if it has.
    void
    refresh_rotations();

    /// About the rotation of each node, the mean of its cells': nine numbers a node, by rows.
    void
    node_rotations(std::vector<float> &rotations);

    /// Requires refresh_rotations().
    Matrix3<double>
    rotation(const unsigned int point) const
    {
      return batches.rotation(point);
    }

    /// Node a at a point in the order of the loops.
    unsigned int
    node(const unsigned int point, const unsigned int a) const
    {
      return batches.node(point, a);
    }

    unsigned int
    n_nodes() const
    {
      return node_positions.size() / 4;
    }

    const CellKernels &
    loops() const
    {
      return kernels;
    }

    CellLaw
    get_law() const
    {
      return law;
    }

    double
    get_guard_bound() const
    {
      return guard_bound;
    }

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    const CellLaw                 law;
    const double                  guard_bound;
    const CellKernels            &kernels;
    const Exchange               &with_others;
    CellBatches                   batches;
    dealii::AlignedVector<double> node_positions; ///< of the last loop, four numbers a node
    dealii::AlignedVector<float>  rotation_sums;
    bool                          rotations_are_forgotten = false; ///< those of node_positions
  };
} // namespace Exemplar

#endif
