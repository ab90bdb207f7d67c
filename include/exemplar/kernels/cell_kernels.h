// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_kernels_h
#define exemplar_cell_kernels_h

#include <exemplar/kernels/cell_task.h>

#include <vector>

// The loops over the cells, compiled for several instruction sets; the best that the CPU
// has is chosen when the program runs. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// A sparse symmetric matrix on the nodes, by rows: the diagonal, which is there first, and what is
  /// right of it.
  struct NodalMatrix
  {
    const std::size_t  *row_starts;
    const unsigned int *columns;
    const double       *values;
  };

  /// The loops over the cells of a group of laws, over batches begin to end - 1.
  struct LawKernels
  {
    void (*update_rotations)(const CellTask &, std::size_t begin, std::size_t end);

    /// Energies; the forces and force scales [N] are added to `nodal_sums`, four numbers a node
    /// of the mesh, and -dPsi/dw_i to the batch of lanes `weight_sums` + 8 i.
    void (*evaluate)(const CellTask &,
                     std::size_t begin,
                     std::size_t end,
                     double     *nodal_sums,
                     double     *weight_sums,
                     CellSums &);

    /// c_i with dPsi/dw = H w - c, into lanes as above.
    void (*weight_linear_term)(const CellTask &,
                               std::size_t begin,
                               std::size_t end,
                               double     *weight_sums);

    /// tr(e) and |F|^2, for patches.
    void (*dilatations)(const CellTask &, std::size_t begin, std::size_t end);

    /// Gamma in strongly stretched patches.
    void (*stretch_energies)(const CellTask &, std::size_t begin, std::size_t end);

    /// Let the law remember a step that ends at these positions, of which the rotations are.
    void (*advance_history)(const CellTask &, std::size_t begin, std::size_t end);

    /// Add R K R^T.
    void (*add_rotated_stiffness)(const CellTask &,
                                  const TangentTask &,
                                  std::size_t begin,
                                  std::size_t end);

    /// Add the exact tangent, or a convex one.
    void (*add_tangent)(const CellTask &, const TangentTask &, std::size_t begin, std::size_t end);

    /// Add what patches add in thin cells and where they are strongly stretched, as far as it couples the nodes
    /// of one cell.
    void (*add_patch_tangent)(const CellTask &,
                              const TangentTask &,
                              std::size_t begin,
                              std::size_t end);

    /// By how much a unit of each example's weight reduces the nodal forces of the cells of one
    /// batch: three entries a node and example, each for all cells of the batch. `rotated`: with
    /// rotations held fixed, as in R K R^T; else by the exact or convex tangent.
    void (*coupling)(
        const CellTask &, const TangentTask &, bool rotated, std::size_t batch, double *forces);
  };

  /// The loops, over batches begin to end - 1.
  struct CellKernels
  {
    const char *name; ///< of the instruction set

    LawKernels of_usual_laws, of_rare_laws, of_sums;

    const LawKernels &
    of(const CellLaw law) const
    {
      return law < first_rare_law ? of_usual_laws : law < first_sum ? of_rare_laws : of_sums;
    }

    /// Add the rotations of the cells to the sums of their nodes, twelve numbers a node of
    /// which nine count.
    void (*add_rotations)(const CellTask &, std::size_t begin, std::size_t end, float *nodal_sums);

    /// The rotations closest to n such sums, nine numbers each.
    void (*closest_rotations)(std::size_t n, const float *sums, float *rotations);

    /// b of the patches begin to end - 1.
    void (*patch_gradients)(const CellArrays &,
                            const PatchArrays &,
                            std::size_t begin,
                            std::size_t end);

    /// Add the products of the patches to the columns of the nodes begin to end - 1. A zero may be added to
    /// the value behind them.
    void (*add_patch_products)(const PatchColumns &,
                               std::size_t begin,
                               std::size_t end,
                               double     *values);

    /// Add the product of a symmetric matrix of n rows with four numbers a node.
    void (*multiply_nodes)(const NodalMatrix &, std::size_t n, const double *x, double *product);
  };

  /// For which loops are compiled; the scalar ones are for tests alone, which compare.
  namespace Instructions
  {
    struct scalar;
    struct baseline;
    struct avx2;
    struct avx512;
  } // namespace Instructions

  // CMake makes a file of source/kernels/*_kernels.cc.in for each of these functions: how much a compiler inlines depends
  // on all that it sees.

  template <typename Set, Element element>
  CellKernels cell_kernels(ElementConstant<element>);

  /// Of the groups of laws beside the usual ones.
  template <typename Set, typename Laws, Element element>
  LawKernels law_kernels(Laws, ElementConstant<element>);

  /// The kernels of an element for the best instruction set that this CPU has.
  const CellKernels &
  best_kernels(Element element);

  /// All that this CPU can run, the best last.
  std::vector<const CellKernels *>
  all_kernels(Element element);
} // namespace Exemplar

#endif
