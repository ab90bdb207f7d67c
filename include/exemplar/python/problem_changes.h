// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_python_problem_changes_h
#define exemplar_python_problem_changes_h

#include <exemplar/python/problem_type.h>

namespace Exemplar::Python
{
  /// Adds to exemplar.Problem the changes between its steps: material, loads, damping, handles,
  /// poses.
  void
  add_changes(ProblemClass &problem);
} // namespace Exemplar::Python

#endif
