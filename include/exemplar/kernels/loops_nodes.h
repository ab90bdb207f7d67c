// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_nodes_h
#define exemplar_loops_nodes_h

#include <exemplar/kernels/loops_io.h>

// The product of a nodal matrix, such as the mass matrix, with a field.

namespace Exemplar::Loops
{
  template <typename Number>
  inline void
  multiply_nodes(const NodalMatrix &matrix, const std::size_t n, const double *x, double *product)
  {
    for (std::size_t row = 0; row < n; ++row)
    {
      std::size_t       k   = matrix.row_starts[row];
      const std::size_t end = matrix.row_starts[row + 1];
      Four              of_row, sum;
      load_four(x + 4 * row, of_row);
      sum = matrix.values[k] * of_row;
      while (++k < end)
      {
        const std::size_t other = 4 * std::size_t(matrix.columns[k]);
        Four              of_other;
        load_four(x + other, of_other);
        sum += matrix.values[k] * of_other;
        add_four(matrix.values[k] * of_row, product + other);
      }
      add_four(sum, product + 4 * row);
    }
  }
} // namespace Exemplar::Loops

#endif
