// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_named_subsections_h
#define exemplar_named_subsections_h

#include <exemplar/prm/assignments.h>

namespace Exemplar
{
  /// Throws UserError if two of the names that Names of a section lists are equal, or if one holds
  /// a character with another meaning in scenes.
  void
  check_names(const std::vector<std::string> &names, const std::string &section);

  /// Remove from `named`, assignments in named subsections, those in subsections of `section` that
  /// the key `list` of it, such as Names, does not list, and return a warning for each such subsection. Throws UnknownKey if
  /// `overrides` set one of them while `others` do not set that key, and if one may be a misspelling
  /// of a listed name that has no subsection.
  std::vector<std::string>
  drop_unlisted(std::vector<Assignment>        &named,
                const std::vector<Assignment>  &others,
                const std::vector<Assignment>  &overrides,
                const std::string              &section,
                const std::vector<std::string> &names,
                const std::string              &list = "Names");
} // namespace Exemplar

#endif
