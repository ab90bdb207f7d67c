// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_python_evaluation_h
#define exemplar_python_evaluation_h

#include <exemplar/python/problem_type.h>

namespace Exemplar::Python
{
  /// Of exemplar.Problem energies, forces and matrices anywhere, and what the cells show of the state.
  void
  add_evaluation(ProblemClass &problem);
} // namespace Exemplar::Python

#endif
