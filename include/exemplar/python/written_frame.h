// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_python_written_frame_h
#define exemplar_python_written_frame_h

#include <exemplar/python/problem_type.h>

namespace Exemplar::Python
{
  /// Adds to exemplar.Problem write().
  void
  add_write(ProblemClass &problem);
} // namespace Exemplar::Python

#endif
