// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_plot_h
#define exemplar_plot_h

#include <exemplar/python/problem_type.h>

namespace Exemplar::Python
{
  /// Adds to exemplar.Problem plot() and animate(), which are written in Python beside the module.
  void
  add_plot(ProblemClass &problem);
} // namespace Exemplar::Python

#endif
