// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_problem_gradients_h
#define exemplar_problem_gradients_h

#include <exemplar/python/problem_type.h>
#include <exemplar/run/adjoint/gradients.h>

#include <string>

namespace Exemplar::Python
{
  /// Adds problem.vjp() to exemplar.Problem.
  void
  add_gradients(ProblemClass &problem);

  /// The result of problem.vjp() for a mesh of n_vertices.
  pybind11::dict
  gradients_to_python(const Gradients &found, std::size_t n_vertices);

  /// An array (n, 3) in the memory of the field, which it takes over.
  pybind11::array
  array_of_nodes(Vector field);

  /// Whether the object is an array with n rows.
  bool
  has_rows(const pybind11::object &array, pybind11::ssize_t n);

  /// Throws UserError unless the object is an array of n finite numbers, one a weight; `what`
  /// stands for it in messages.
  void
  check_weight_derivatives(const pybind11::object &array, const std::string &what, std::size_t n);
} // namespace Exemplar::Python

#endif
