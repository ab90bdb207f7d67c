// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_module_parts_h
#define exemplar_module_parts_h

#include <exemplar/python/problem_type.h>

// The parts of the module, each in a file of its own.

namespace Exemplar::Python
{
  /// Adds exemplar.State to the module, and state, step(), goto() and reset() to exemplar.Problem.
  void
  add_saved_states(pybind11::module_ &module, ProblemClass &problem);

  /// Adds to exemplar.Problem the changes between its steps: material, loads, damping, handles,
  /// poses.
  void
  add_changes(ProblemClass &problem);

  /// Adds to exemplar.Problem what obstacles do to the body.
  void
  add_obstacles(ProblemClass &problem);

  /// Adds to exemplar.Problem the arrays of the state in its cells.
  void
  add_cell_arrays(ProblemClass &problem);

  /// Adds to exemplar.Problem the properties of its body (material, cells, surface, handles and
  /// examples) and its printed form.
  void
  add_body(ProblemClass &problem);

  /// Adds to exemplar.Problem write().
  void
  add_write(ProblemClass &problem);

  /// Adds to exemplar.Problem add_term() and check_term().
  void
  add_terms(ProblemClass &problem);

  /// Adds to exemplar.Problem plot() and animate(), which are written in Python beside the module.
  void
  add_plot(ProblemClass &problem);

  /// Adds to exemplar.Problem live(), which is written in Python beside the module.
  void
  add_live(ProblemClass &problem);

  /// Append to the docstrings of all public names an example, as Python's doctest reads it. To be
  /// called when all of them are there, before add_signatures().
  void
  add_examples(const pybind11::module_ &module);

  /// Let inspect.signature(), help() and editors read the calls with which docstrings begin, as
  /// "name(a, b=None) -> type" before an empty line: those of the module's functions and of the
  /// methods of its types. To be called when all of them are there.
  void
  add_signatures(const pybind11::module_ &module);
} // namespace Exemplar::Python

#endif
