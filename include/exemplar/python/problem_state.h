// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_python_problem_state_h
#define exemplar_python_problem_state_h

#include <exemplar/python/problem_type.h>

namespace Exemplar::Python
{
  /// Adds exemplar.State to the module, and state, step(), goto() and reset() to exemplar.Problem.
  void
  add_saved_states(pybind11::module_ &module, ProblemClass &problem);
} // namespace Exemplar::Python

#endif
