// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_problem_gradients_h
#define exemplar_problem_gradients_h

#include <exemplar/python/problem_type.h>

namespace Exemplar::Python
{
  /// problem.vjp().
  void
  add_gradients(ProblemClass &problem);
} // namespace Exemplar::Python

#endif
