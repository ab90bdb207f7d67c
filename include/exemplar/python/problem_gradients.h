// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_problem_gradients_h
#define exemplar_problem_gradients_h

#include <exemplar/python/problem_type.h>
#include <exemplar/run/adjoint/gradients.h>

#include <string>

namespace Exemplar::Python
{
  /// problem.vjp().
  void
  add_gradients(ProblemClass &problem);

  /// What problem.vjp() returns, of a mesh of so many vertices.
  pybind11::dict
  gradients_to_python(const Gradients &found, std::size_t n_vertices);

  /// (n, 3) in the memory of the field, which is the array's from now on.
  pybind11::array
  array_of_nodes(Vector field);

  /// Whether it is an array with so many rows.
  bool
  has_rows(const pybind11::object &array, pybind11::ssize_t n);

  /// Throws UserError for what is no array of a finite number for each of n weights; `what` stands for it.
  void
  check_weight_derivatives(const pybind11::object &array, const std::string &what, std::size_t n);
} // namespace Exemplar::Python

#endif
