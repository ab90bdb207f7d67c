// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_python_problem_obstacles_h
#define exemplar_python_problem_obstacles_h

#include <exemplar/python/problem_type.h>

namespace Exemplar::Python
{
  /// Adds to exemplar.Problem what obstacles do to the body.
  void
  add_obstacles(ProblemClass &problem);
} // namespace Exemplar::Python

#endif
