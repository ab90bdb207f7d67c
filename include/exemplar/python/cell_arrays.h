// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_python_cell_arrays_h
#define exemplar_python_cell_arrays_h

#include <exemplar/python/problem_type.h>

namespace Exemplar::Python
{
  /// Adds to exemplar.Problem the arrays of the state in its cells.
  void
  add_cell_arrays(ProblemClass &problem);
} // namespace Exemplar::Python

#endif
