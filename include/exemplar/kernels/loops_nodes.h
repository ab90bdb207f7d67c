// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_nodes_h
#define exemplar_loops_nodes_h

#include <exemplar/kernels/loops_io.h>

// The product of a matrix on the nodes, as that of the masses, with a field.

namespace Exemplar::Loops
{
  template <typename Number>
  inline void
  multiply_nodes(const NodalMatrix &matrix, const std::size_t n, const double *x, double *product)
  {
    for (std::size_t row = 0; row < n; ++row)
    {
      Four       sum[2] = {}; // additions to one would wait for each other
      const auto add    = [&](const std::size_t k, Four &to)
      {
        Four of_node; // and the first number of the next one
        load_four(x + 3 * matrix.columns[k], of_node);
        to += matrix.values[k] * of_node;
      };
      std::size_t       k   = matrix.row_starts[row];
      const std::size_t end = matrix.row_starts[row + 1];
      for (; k + 2 <= end; k += 2)
      {
        add(k, sum[0]);
        add(k + 1, sum[1]);
      }
      if (k < end)
        add(k, sum[0]);
      sum[0] += sum[1];
      for (int c = 0; c < 3; ++c)
        product[3 * row + c] = sum[0][c];
    }
  }
} // namespace Exemplar::Loops

#endif
