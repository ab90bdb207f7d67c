// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_plot_h
#define exemplar_plot_h

#include <pybind11/pybind11.h>

namespace Exemplar::Python
{
  /// Give the type exemplar.Problem the method plot(), which is written in Python beside the module.
  void
  add_plot(const pybind11::object &problem);
} // namespace Exemplar::Python

#endif
