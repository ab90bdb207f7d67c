// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_problem_live_h
#define exemplar_problem_live_h

#include <exemplar/python/problem_type.h>

namespace Exemplar::Python
{
  /// Adds to exemplar.Problem live(), which is written in Python beside the module.
  void
  add_live(ProblemClass &problem);
} // namespace Exemplar::Python

#endif
