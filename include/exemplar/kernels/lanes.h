// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_lanes_h
#define exemplar_lanes_h

#include <algorithm>
#include <cmath>
#include <cstddef>

// Kernels are written once for a number type: double, or a batch of doubles of xsimd. Functions
// beyond arithmetic are declared here for double; for batches, argument-dependent lookup finds
// those of xsimd.
// No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// Number of cells in a batch, whose quantities are stored side by side, whatever the width of
  /// the CPU's registers.
  constexpr std::size_t batch_size = 8;

  /// Position of entry e of a quantity with n entries a cell.
  inline std::size_t
  batch_index(const std::size_t cell, const std::size_t n, const std::size_t e)
  {
    return (cell / batch_size * n + e) * batch_size + cell % batch_size;
  }

  /// Size of the array of a quantity with n entries a cell: whole batches.
  inline std::size_t
  batched_size(const std::size_t n_cells, const std::size_t n)
  {
    return (n_cells + batch_size - 1) / batch_size * batch_size * n;
  }

  using std::abs;
  using std::max;
  using std::min;
  using std::sqrt;

  inline double
  select(const bool condition, const double a, const double b)
  {
    return condition ? a : b;
  }

  inline bool
  any(const bool condition)
  {
    return condition;
  }

  inline bool
  all(const bool condition)
  {
    return condition;
  }

  /// The lanes of a number type, one a cell, and their loads and stores.
  template <typename Number>
  struct Lanes
  {
    static constexpr std::size_t n = Number::size;

    static Number
    load(const double *from)
    {
      return Number::load_aligned(from);
    }

    static void
    store(const Number &number, double *to)
    {
      number.store_aligned(to);
    }
  };

  template <>
  struct Lanes<double>
  {
    static constexpr std::size_t n = 1;

    static double
    load(const double *from)
    {
      return *from;
    }

    static void
    store(const double number, double *to)
    {
      *to = number;
    }
  };
} // namespace Exemplar

#endif
