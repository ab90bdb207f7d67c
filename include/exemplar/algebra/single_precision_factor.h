// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_single_precision_factor_h
#define exemplar_single_precision_factor_h

#include <cstddef>
#include <vector>

// A Cholesky factor kept in single precision: solving with it costs a third of what the
// factor itself costs, and an approximate inverse needs no more digits. No deal.II header
// here: see matrix3.h.

namespace Exemplar
{
  /// L of P A P^T = L L^T by supernodes: each is a dense block of consecutive columns with
  /// the same rows below its triangle, stored by columns. The diagonal holds 1/L_cc.
  struct FactorPanels
  {
    std::vector<int>         permutation;  ///< row i of L is row permutation[i] of A
    std::vector<int>         first_column; ///< of each supernode, and n
    std::vector<std::size_t> first_row;    ///< where its rows begin in `rows`, and the end
    std::vector<std::size_t> first_value;  ///< where its block begins in `values`
    std::vector<int>         rows;         ///< of L, ascending; the block's own columns first
    std::vector<float>       values;       ///< and `max_lanes` more

    static constexpr std::size_t max_lanes = 16; ///< in a register
  };

  /// A Cholesky factor in single precision, for solutions that need a few digits only.
  class SinglePrecisionFactor
  {
  public:
    SinglePrecisionFactor() = default;

    explicit SinglePrecisionFactor(FactorPanels panels);

    /// Overwrite a vector of n entries, in the order of A, by about A^-1 times it.
    void
    solve(std::vector<float> &vector);

    bool
    empty() const
    {
      return panels.permutation.empty();
    }

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    FactorPanels       panels;
    std::vector<float> permuted, block;
  };

  /// The two triangular solves for an instruction set. `block` has as many entries as the
  /// greatest supernode has rows, and `max_lanes` more.
  struct TriangularKernels
  {
    void (*forward)(const FactorPanels &, float *vector, float *block);
    void (*backward)(const FactorPanels &, float *vector, float *block);
  };
} // namespace Exemplar

#endif
