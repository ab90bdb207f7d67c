// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_plain_name_h
#define exemplar_plain_name_h

#include <string>

namespace Exemplar
{
  /// Throws UserError, calling it `what`, for a name that a list of names or a column of a table cannot hold: an empty one,
  /// and one with a comma, a control character or a blank at an end.
  void
  require_plain_name(const std::string &name, const std::string &what);
} // namespace Exemplar

#endif
