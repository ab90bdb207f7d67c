// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_python_body_properties_h
#define exemplar_python_body_properties_h

#include <exemplar/python/problem_type.h>

namespace Exemplar::Python
{
  /// Of exemplar.Problem what it is made of: its material, cells, surface, handles and examples, and how it is
  /// printed.
  void
  add_body(ProblemClass &problem);
} // namespace Exemplar::Python

#endif
