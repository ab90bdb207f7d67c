// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_kept_inverse_h
#define exemplar_kept_inverse_h

#include <exemplar/algebra/inverse_entries.h>

#include <memory>
#include <vector>

namespace Exemplar
{
  /// An approximate inverse of a matrix that stays valid when its operator is factorised anew: say,
  /// a copy of the factor in single precision, or a multigrid cycle.
  class KeptInverse
  {
  public:
    virtual ~KeptInverse() = default;

    /// Overwrite a vector v, by unknown, by an approximation of A^-1 v.
    virtual void
    apply(std::vector<double> &vector)
        = 0;

    /// Single entries of this inverse, which stay good as long as it does; null if they cost as much as columns.
    virtual std::unique_ptr<InverseEntries>
    entries() const
    {
      return nullptr;
    }

    /// Cost of making this inverse anew and of solving for n_columns right sides with the new
    /// matrix, in units of one iteration that evaluates the forces and applies the inverse once:
    /// from operation counts, never from a clock.
    virtual double
    cost_in_iterations(std::size_t n_columns) const = 0;

    /// Memory in bytes.
    virtual std::size_t
    memory_consumption() const = 0;
  };
} // namespace Exemplar

#endif
