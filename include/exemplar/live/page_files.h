// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_page_files_h
#define exemplar_live_page_files_h

#include <string>

namespace Exemplar::Live
{
  /// The bytes of a file of exemplar's page, or of three.js in Debian's package. Throws UserError
  /// if it is missing.
  std::string
  page_file(const std::string &name);

  std::string
  three_file(const std::string &name);
} // namespace Exemplar::Live

#endif
