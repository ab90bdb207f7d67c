// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_kept_inverse_h
#define exemplar_kept_inverse_h

#include <cstddef>
#include <vector>

namespace Exemplar
{
  /// An approximate inverse of a matrix that outlives the next factorisation of its operator: a
  /// copy of the factor in single precision, say, or a multigrid cycle.
  class KeptInverse
  {
  public:
    virtual ~KeptInverse() = default;

    /// Overwrite a vector, by free degree of freedom, by about A^-1 times it.
    virtual void
    apply(std::vector<double> &vector)
        = 0;

    /// What it costs to make this inverse anew, and to solve for some columns with the matrix then,
    /// in iterations of a method that evaluates the forces and applies the inverse once: from counts
    /// of operations, never from a clock.
    virtual double
    cost_in_iterations(std::size_t n_columns) const = 0;

    /// In bytes.
    virtual std::size_t
    memory_consumption() const = 0;
  };
} // namespace Exemplar

#endif
