// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_python_own_terms_h
#define exemplar_python_own_terms_h

#include <exemplar/python/problem_type.h>

namespace Exemplar::Python
{
  /// Adds to exemplar.Problem add_term() and check_term().
  void
  add_terms(ProblemClass &problem);
} // namespace Exemplar::Python

#endif
