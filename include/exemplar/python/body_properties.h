// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_python_body_properties_h
#define exemplar_python_body_properties_h

#include <exemplar/python/problem_type.h>

namespace Exemplar::Python
{
  /// Adds to exemplar.Problem the properties of its body (material, cells, surface, handles and
  /// examples) and its printed form.
  void
  add_body(ProblemClass &problem);
} // namespace Exemplar::Python

#endif
