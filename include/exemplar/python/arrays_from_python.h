// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_arrays_from_python_h
#define exemplar_arrays_from_python_h

#include <exemplar/mesh/mesh_inputs.h>

#include <pybind11/numpy.h>

#include <string>
#include <vector>

// Conversion of Python's arrays. All functions throw UserError, with rows counted from 0, for
// arrays that do not fit.

namespace Exemplar::Python
{
  /// The kind of an object in words, as in "an array of shape (9, 2)" or "a NoneType".
  std::string
  description(const pybind11::handle &object);

  /// Throws UserError unless an array has real numbers: numpy would drop the imaginary parts of
  /// complex ones.
  void
  require_real(const pybind11::array &array, const std::string &what);

  /// The value float(object). Throws Python's TypeError for anything else, and for complex numbers.
  double
  real_number_of(const pybind11::handle &object, const std::string &what);

  /// The rows of an array (n, 3) of finite numbers, or any number of them where n is negative;
  /// `what` stands for it in messages.
  std::vector<dealii::Point<3>>
  points_of(const pybind11::handle &object, const std::string &what, pybind11::ssize_t n = -1);

  /// n numbers from an array (n) of finite numbers, or one number from a single one.
  std::vector<double>
  numbers_of(const pybind11::handle &object, const std::string &what, pybind11::ssize_t n);

  /// Indices from 0 of some of n nodes, given in any order; returned ascending, each once.
  std::vector<unsigned int>
  nodes_of(const pybind11::handle &object, const std::string &what, std::size_t n);

  /// The mesh of a tuple (nodes, cells) or (nodes, cells, material ids).
  MshFile
  mesh_of(const pybind11::object &mesh, MeshKind kind);
} // namespace Exemplar::Python

#endif
