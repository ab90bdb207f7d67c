// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_batches_h
#define exemplar_cell_batches_h

#include <exemplar/body/fe_space.h>
#include <exemplar/body/laws_of_cells.h>
#include <exemplar/body/material.h>
#include <exemplar/kernels/cell_kernels.h>

#include <deal.II/base/aligned_vector.h>

#include <vector>

namespace Exemplar
{
  /// The quadrature points of the cells in batches, as CellArrays describes them, and the rotation
  /// of each.
  class CellBatches
  {
  public:
    CellBatches(const FESpace &fe_space, const Material &material, const LawsOfCells &laws);

    /// What loops see that are the same for all laws. `guard_bound` is p_0 of Eq. (16).
    CellArrays
    arrays(double guard_bound);

    /// Call function(cells) for each law with what loops see that are for its cells alone; those that
    /// update rotations write them here.
    template <typename Function>
    void
    for_each_law(CellArrays cells, const Function &function) const
    {
      cells.has_other_laws = of_laws.size() > 1;
      for (const OfLaw &of_law : of_laws)
      {
        cells.law     = of_law.law;
        cells.volumes = cells.has_other_laws ? of_law.volumes.data() : volumes.data();
        function(cells);
      }
    }

    Matrix3<double>
    rotation(const unsigned int point) const
    {
      Matrix3<double> R;
      for (unsigned int k = 0; k < 9; ++k)
        R[k / 3][k % 3] = rotations[batch_index(point, 9, k)];
      return R;
    }

    /// Node a at a point. All arrays have the nodes of a cell in ascending order of their numbers.
    unsigned int
    node(const unsigned int point, const unsigned int a) const
    {
      return nodes[batch_index(point, n_nodes, a)];
    }

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    struct OfLaw
    {
      CellLaw                       law;
      dealii::AlignedVector<double> volumes; ///< 0 in cells of others; empty if there are none
    };

    const std::size_t             n_points;
    const std::size_t             n_nodes; ///< of each
    std::vector<int>              nodes;
    dealii::AlignedVector<double> gradients;
    dealii::AlignedVector<double> volumes;
    dealii::AlignedVector<double> material;
    dealii::AlignedVector<double> rotations;
    std::vector<OfLaw>            of_laws;
  };
} // namespace Exemplar

#endif
