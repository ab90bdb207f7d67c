// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_front_kernels_h
#define exemplar_front_kernels_h

#include <exemplar/algebra/factor_structure.h>

#include <cstddef>

// No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// Hot loops of multifrontal factorisation for an instruction set. Matrices are stored by
  /// columns, `stride` apart. Loads reach up to `max_lanes` numbers beyond the last one.
  template <typename Number>
  struct FrontKernels
  {
    static constexpr std::size_t max_lanes = 64 / sizeof(Number); ///< numbers in a register

    /// Overwrite the columns of a panel, lower triangle first, by those of its Cholesky factor.
    /// False if it is not positive definite.
    bool (*factorize)(Number *panel, std::ptrdiff_t stride, int n_rows, int n_columns);

    /// C -= A A_c^T, or C = -A A_c^T with `overwrite`. A is n_rows x n_inner, A_c are its first
    /// n_columns rows. Only the diagonal of C and what is below it are computed.
    void (*subtract_square)(const Number  *A,
                            std::ptrdiff_t stride_of_A,
                            int            n_inner,
                            int            n_rows,
                            int            n_columns,
                            Number        *C,
                            std::ptrdiff_t stride_of_C,
                            bool           overwrite);

    /// target[places[i]] += column[i].
    void (*add_scattered)(const Number *column, const int *places, int n, Number *target);

    /// Forward and backward substitution, x = L^-1 x and x = L^-T x, restricted to supernodes begin
    /// to end - 1. Forward also adds their updates to rows further below; backward takes those rows
    /// as known. `block` has as many entries as the greatest supernode has rows, plus `max_lanes`.
    void (*forward)(const FactorStructure &,
                    const Number *values,
                    const Number *inverse_diagonal,
                    int           begin,
                    int           end,
                    Number       *vector,
                    Number       *block);
    void (*backward)(const FactorStructure &,
                     const Number *values,
                     const Number *inverse_diagonal,
                     int           begin,
                     int           end,
                     Number       *vector,
                     Number       *block);
  };

  /// The kernels of the best instruction set that this CPU has.
  template <typename Number>
  const FrontKernels<Number> &
  front_kernels();
} // namespace Exemplar

#endif
