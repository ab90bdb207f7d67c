// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_batches_h
#define exemplar_cell_batches_h

#include <exemplar/body/fe_space.h>
#include <exemplar/body/material.h>
#include <exemplar/kernels/cell_kernels.h>

#include <deal.II/base/aligned_vector.h>

namespace Exemplar
{
  /// The cells in batches, as CellArrays describes them, and the rotation of each.
  class CellBatches
  {
  public:
    /// With `has_patches` the volume part of the energy is not the cells'.
    CellBatches(const FESpace &fe_space, const Material &material, bool has_patches);

    /// What the kernels see, for a model with this strain and p_0 of Eq. (16). Loops that update
    /// rotations write them here.
    CellArrays
    arrays(StrainMeasure strain, double guard_bound);

    Matrix3<double>
    rotation(const unsigned int cell) const
    {
      Matrix3<double> R;
      for (unsigned int k = 0; k < 9; ++k)
        R[k / 3][k % 3] = rotations[batch_index(cell, 9, k)];
      return R;
    }

    /// Node a of a cell. All arrays have the nodes of a cell in ascending order of their numbers.
    unsigned int
    node(const unsigned int cell, const unsigned int a) const
    {
      return nodes[batch_index(cell, 4, a)];
    }

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    void
    store_material(const CellMaterial<double> &elasticity, std::size_t slot);

    const std::size_t             n_cells;
    std::vector<int>              nodes;
    dealii::AlignedVector<double> gradients;
    dealii::AlignedVector<double> volumes;
    dealii::AlignedVector<double> material;
    dealii::AlignedVector<double> guard_material; ///< empty if it is the same
    dealii::AlignedVector<double> rotations;
  };
} // namespace Exemplar

#endif
