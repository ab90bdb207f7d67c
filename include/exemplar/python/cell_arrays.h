// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_python_cell_arrays_h
#define exemplar_python_cell_arrays_h

#include <exemplar/python/problem_type.h>

namespace Exemplar::Python
{
  /// Of exemplar.Problem what its cells show of the state.
  void
  add_cell_arrays(ProblemClass &problem);
} // namespace Exemplar::Python

#endif
