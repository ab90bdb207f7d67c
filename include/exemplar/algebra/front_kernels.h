// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_front_kernels_h
#define exemplar_front_kernels_h

#include <exemplar/algebra/factor_structure.h>

#include <cstddef>

// No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// What a factorisation by fronts spends its time with, for an instruction set. Matrices are stored
  /// by columns, `stride` apart. Loads reach up to `max_lanes` numbers beyond the last one.
  template <typename Number>
  struct FrontKernels
  {
    static constexpr std::size_t max_lanes = 64 / sizeof(Number); ///< in a register

    /// Overwrite the n columns of a panel, lower triangle first, by those of its Cholesky factor.
    /// False if it is not positive definite.
    bool (*factorize)(Number *panel, std::ptrdiff_t stride, int n_rows, int n_columns);

    /// Subtract A A_c^T from C, or make C minus that: A has n_rows rows and n_inner columns, A_c are
    /// the first n_columns rows of A. Of C only what is on and below the diagonal.
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

    /// Overwrite the entries of a vector that belong to supernodes begin to end - 1 by those of
    /// L^-1 and L^-T times it. Forward adds what rows further below lose, backward takes these as
    /// they are. `block` has as many entries as the greatest supernode has rows, and `max_lanes`.
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

  /// Those of the best instruction set that this CPU has.
  template <typename Number>
  const FrontKernels<Number> &
  front_kernels();
} // namespace Exemplar

#endif
