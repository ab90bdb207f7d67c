// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_front_kernels_h
#define exemplar_front_kernels_h

#include <exemplar/algebra/factor_structure.h>

#include <cstddef>

// No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// Columns of L in slabs, from a row on where a slab begins: an operand of products.
  template <typename Number>
  struct SlabColumns
  {
    const Number *values;
    int           width; ///< number of columns
  };

  /// A matrix of which 16 rows of a column stand beside each other: by columns, or in slabs.
  template <typename Number>
  struct SlabTarget
  {
    Number        *values;
    std::ptrdiff_t slab_stride; ///< from a row to that of the next slab
    std::ptrdiff_t column_stride;
    std::ptrdiff_t last_column_stride; ///< in a last slab of fewer rows
  };

  /// A vector by the rows of all supernodes for each of several right sides.
  template <typename Number>
  struct SupernodeVectors
  {
    Number     *values;
    std::size_t stride; ///< between right sides
    int         number; ///< of right sides, at most max_number

    static constexpr int max_number = 4;
  };

  /// Hot loops of multifrontal factorisation for an instruction set. Loads reach up to `max_lanes` numbers beyond the last one.
  template <typename Number>
  struct FrontKernels
  {
    static constexpr std::size_t max_lanes = slab_rows; ///< at least the numbers in a register

    /// C -= A A_c^T, or C = -A A_c^T with `overwrite`, with A the columns of all the blocks side by side, of n_rows rows, and A_c its
    /// first n_columns rows. Of C rows begin to end - 1 are computed, from the slab of the diagonal on. begin is a multiple of
    /// slab_rows, and so is end, or n_rows.
    void (*subtract_products)(const SlabColumns<Number> *blocks,
                              int                        n_blocks,
                              int                        n_rows,
                              int                        begin,
                              int                        end,
                              int                        n_columns,
                              SlabTarget<Number>         C,
                              bool                       overwrite);

    /// A lower triangle by columns, PanelBlock::max_width apart, is overwritten by its Cholesky factor. False if it is not
    /// positive definite.
    bool (*factorize_triangle)(Number *triangle, int width);

    /// Write the inverse of this Cholesky factor, and the transposed inverse, to the slabs of a block of a panel.
    void (*write_inverse)(const Number *triangle, const PanelBlock &block, Number *panel);

    /// A = A L^-T for rows begin to end - 1 below the triangle of a block, of which the inverse is there.
    void (*finish_rows)(const PanelBlock &block, int begin, int end, Number *panel);

    /// Add n_rows rows, at most those of a slab, of n_columns columns: the column c to that at column_places[c] - first_place.
    void (*add_rows)(const Number  *from,
                     std::ptrdiff_t stride,
                     const int     *column_places,
                     int            n_columns,
                     int            first_place,
                     int            n_rows,
                     Number        *to,
                     std::ptrdiff_t stride_of_target);

    /// Forward and backward substitution for supernodes begin to end - 1. Forward takes the right side at their columns, and
    /// leaves the intermediate solution there; below are the updates for their parents. Backward overwrites it by the solution.
    void (*forward)(const FactorStructure &,
                    const Number            *values,
                    int                      begin,
                    int                      end,
                    SupernodeVectors<Number> vectors);
    void (*backward)(const FactorStructure &,
                     const Number            *values,
                     int                      begin,
                     int                      end,
                     SupernodeVectors<Number> vectors);
  };

  /// The kernels of the best instruction set that this CPU has.
  template <typename Number>
  const FrontKernels<Number> &
  front_kernels();
} // namespace Exemplar

#endif
