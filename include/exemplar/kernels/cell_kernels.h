// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_kernels_h
#define exemplar_cell_kernels_h

#include <exemplar/kernels/cell_task.h>

#include <vector>

// The loops over the cells, compiled for several instruction sets; the best that the CPU has is
// chosen at run time. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// The upper triangle of a sparse symmetric matrix on the nodes, by rows, each beginning with its
  /// diagonal entry.
  struct NodalMatrix
  {
    const std::size_t  *row_starts;
    const unsigned int *columns;
    const double       *values;
  };

  /// Cells with active fibres, as their loops read them.
  struct FibreArrays
  {
    const unsigned int *nodes;  ///< 4 or 10 a cell
    const double       *shares; ///< shape gradients along the fibre [1/m], alike a point
  };

  /// The loops over the cells of an element, for batches begin to end - 1; those with a task are for
  /// the task's law.
  struct CellKernels
  {
    const char *name; ///< name of the instruction set

    void (*update_rotations)(const CellTask &, std::size_t begin, std::size_t end);

    /// Compute energies; add forces and force scales [N] to `nodal_sums`, four numbers a node of
    /// the mesh, and -dPsi/dw_i to the batch of lanes `weight_sums` + 8 i.
    void (*evaluate)(const CellTask &,
                     std::size_t begin,
                     std::size_t end,
                     double     *nodal_sums,
                     double     *weight_sums,
                     CellSums &);

    /// Add c_i of dPsi/dw = H w - c to the lanes of weight_sums, as evaluate().
    void (*weight_linear_term)(const CellTask &,
                               std::size_t begin,
                               std::size_t end,
                               double     *weight_sums);

    /// Compute tr(e) and |F|^2 for patches.
    void (*dilatations)(const CellTask &, std::size_t begin, std::size_t end);

    /// Compute Gamma in strongly stretched patches, Eq. (26).
    void (*stretch_energies)(const CellTask &, std::size_t begin, std::size_t end);

    /// Update the history variables at the end of a step, for these positions and their rotations.
    void (*advance_history)(const CellTask &, std::size_t begin, std::size_t end);

    /// Add the tangent of the law.
    void (*add_tangent)(const CellTask &, const TangentTask &, std::size_t begin, std::size_t end);

    /// Add the tangent of patches in thin cells and where they are strongly stretched, as far as it
    /// couples the nodes of one cell.
    void (*add_patch_tangent)(const CellTask &,
                              const TangentTask &,
                              std::size_t begin,
                              std::size_t end);

    /// Columns of the coupling for one batch: the decrease of the nodal forces for a unit of each
    /// example's weight, three entries a node and example, each for all cells of the batch.
    void (*coupling)(const CellTask &, bool convex, std::size_t batch, double *forces);

    /// Find the derivatives of the slope of the law's energy, see SlopeTask. The law has a potential.
    void (*slopes)(const CellTask &, const SlopeTask &, std::size_t begin, std::size_t end);

    /// Find SlopeEntry::value alone, one number a cell, without the guard of the stretch.
    void (*works)(const CellTask &, const SlopeTask &, std::size_t begin, std::size_t end);

    /// Find the traces of strains and their changes, TraceEntry::size numbers a cell, in laws with
    /// trace_gradient_is_R.
    void (*traces)(const CellTask &, const SlopeTask &, std::size_t begin, std::size_t end);

    /// Add `factor` times the strains e, with the rotations at the task's positions, to `strains`,
    /// six numbers a cell, and set `factors`, one a cell, to 0 where the guard of Eq. (16) acts.
    void (*add_strains)(const CellTask &,
                        double      factor,
                        std::size_t begin,
                        std::size_t end,
                        double     *strains,
                        double     *factors);

    /// Add the rotations of the cells to sums at their nodes, twelve numbers a node of which nine
    /// count.
    void (*add_rotations)(const CellTask &, std::size_t begin, std::size_t end, float *nodal_sums);

    /// The rotations closest to n sums of add_rotations(), nine numbers each.
    void (*closest_rotations)(std::size_t n, const float *sums, float *rotations);

    /// Compute the gradients b of the mean dilatations of patches begin to end - 1.
    void (*patch_gradients)(const CellArrays &,
                            const PatchArrays &,
                            std::size_t begin,
                            std::size_t end);

    /// Add the outer products of the patches to the matrix columns of nodes begin to end - 1. A
    /// zero may be added to the value behind a column.
    void (*add_patch_products)(const PatchColumns &,
                               std::size_t begin,
                               std::size_t end,
                               double     *values);

    /// Add the product of a symmetric matrix of n rows with four numbers a node.
    void (*multiply_nodes)(const NodalMatrix &, std::size_t n, const double *x, double *product);

    /// Find the vectors F a of points begin to end - 1 from positions of four numbers a node: four numbers a point, from the
    /// first point on, of which the last means nothing.
    void (*fibre_vectors)(const FibreArrays &,
                          std::size_t   begin,
                          std::size_t   end,
                          const double *positions,
                          double       *vectors);

    /// Replace n vectors F a by what add_fibre_forces() takes where the energy of a point is its amount [J] times |F a| - 1, which below the
    /// least stretch goes on as a parabola of equal slope. Returns the energy [J].
    double (*pull_fibres)(const double *amounts,
                          std::size_t   n,
                          double        least_stretch,
                          double       *vectors);

    /// Add forces of points begin to end - 1, the derivative by F a and a number >= 0 a point, to four numbers a node: times
    /// the shape gradients along the fibre, of which the last one's sign does not count.
    void (*add_fibre_forces)(const FibreArrays &,
                             std::size_t   begin,
                             std::size_t   end,
                             const double *forces,
                             double       *nodal_sums);
  };

  /// Instruction sets for which loops are compiled; the scalar one is a reference for tests.
  namespace Instructions
  {
    struct scalar;
    struct baseline;
    struct avx2;
    struct avx512;
  } // namespace Instructions

  // CMake makes a source file of source/kernels/cell_kernels.cc.in for each instance.

  template <typename Set, Element element>
  CellKernels cell_kernels(ElementConstant<element>);

  /// The kernels of an element for the best instruction set that this CPU has.
  const CellKernels &
  best_kernels(Element element);

  /// All kernels that this CPU can run, the best last.
  std::vector<const CellKernels *>
  all_kernels(Element element);
} // namespace Exemplar

#endif
