// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_sparse_entries_h
#define exemplar_sparse_entries_h

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace Exemplar::Python
{
  /// An entry of a symmetric matrix, in its lower triangle: row >= column.
  struct MatrixEntry
  {
    unsigned int row, column;
    double       value;
  };

  /// The lower triangle of a Hessian (n, n), a sparse array of scipy; None has no entries. `what`
  /// stands for it in messages. Throws UserError for anything else: other shapes, entries that are
  /// no finite real numbers, indices that lead out of the arrays or of the matrix, what is not
  /// symmetric.
  std::vector<MatrixEntry>
  lower_entries_of(const pybind11::object &hessian, std::size_t n, const std::string &what);
} // namespace Exemplar::Python

#endif
