// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_python_examples_h
#define exemplar_python_examples_h

#include <pybind11/pybind11.h>

namespace Exemplar::Python
{
  /// Append to the docstrings of all public names an example, as Python's doctest reads it. To be
  /// called when all of them are there, before add_signatures().
  void
  add_examples(const pybind11::module_ &module);
} // namespace Exemplar::Python

#endif
