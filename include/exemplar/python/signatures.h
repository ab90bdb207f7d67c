// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_signatures_h
#define exemplar_signatures_h

#include <pybind11/pybind11.h>

namespace Exemplar::Python
{
  /// Let inspect.signature(), help() and editors read the calls with which docstrings begin, as
  /// "name(a, b=None) -> type" before an empty line: those of the module's functions and of the
  /// methods of its types. To be called when all of them are there.
  void
  add_signatures(const pybind11::module_ &module);
} // namespace Exemplar::Python

#endif
