// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_arrays_to_python_h
#define exemplar_arrays_to_python_h

#include <exemplar/run/problem/laboratory.h>

#include <pybind11/numpy.h>

#include <utility>
#include <vector>

// Conversion of numbers of exemplar to arrays of Python.

namespace Exemplar::Python
{
  using Shape = std::vector<pybind11::ssize_t>;

  /// An array that keeps the memory of a vector, which has as many numbers as the shape.
  template <typename Number>
  pybind11::array
  array_of(std::vector<Number> numbers, Shape shape)
  {
    auto *const             kept = new std::vector<Number>(std::move(numbers));
    const pybind11::capsule owner(kept, [](void *old)
                                  { delete static_cast<std::vector<Number> *>(old); });
    return pybind11::array_t<Number>(std::move(shape), kept->data(), owner);
  }

  /// An array of 3 x 3 matrices, whose nine numbers are by rows.
  pybind11::array
  array_of(const std::vector<Matrix3<double>> &matrices, Shape shape);

  /// An array (m, n), by rows.
  pybind11::array
  array_of(const dealii::FullMatrix<double> &matrix);

  /// A module of scipy. Throws Python's ImportError, which says how to install it.
  pybind11::module_
  scipy(const char *name);

  /// A scipy.sparse.csr_array in the memory of the matrix.
  pybind11::object
  sparse_array(RowMatrix matrix);
} // namespace Exemplar::Python

#endif
