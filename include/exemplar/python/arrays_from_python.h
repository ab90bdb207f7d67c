// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_arrays_from_python_h
#define exemplar_arrays_from_python_h

#include <exemplar/mesh/mesh_inputs.h>

#include <pybind11/numpy.h>

#include <string>
#include <vector>

// What Python's arrays mean to exemplar. All throw UserError, with rows counted from 0, for what
// these cannot be.

namespace Exemplar::Python
{
  /// In words, as in "an array of shape (9, 2)" or "a NoneType".
  std::string
  description(const pybind11::handle &object);

  /// Throws UserError unless an array has real numbers: numpy would drop the imaginary parts of complex ones.
  void
  require_real(const pybind11::array &array, const std::string &what);

  /// What float() makes of it. Throws Python's TypeError for anything else, and for complex numbers.
  double
  real_number_of(const pybind11::handle &object, const std::string &what);

  /// The rows of an array (n, 3) of finite numbers, or any number of them where n is negative;
  /// `what` stands for it in messages.
  std::vector<dealii::Point<3>>
  points_of(const pybind11::handle &object, const std::string &what, pybind11::ssize_t n = -1);

  /// A number, or an array (n) of finite numbers: then n of them, else one.
  std::vector<double>
  numbers_of(const pybind11::handle &object, const std::string &what, pybind11::ssize_t n);

  /// Indices from 0 of some of n nodes, in any order; ascending, each once.
  std::vector<unsigned int>
  nodes_of(const pybind11::handle &object, const std::string &what, std::size_t n);

  /// A tuple (nodes, cells) or (nodes, cells, material ids).
  MshFile
  mesh_of(const pybind11::object &mesh);
} // namespace Exemplar::Python

#endif
