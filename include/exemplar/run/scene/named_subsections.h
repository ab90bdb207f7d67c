// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_named_subsections_h
#define exemplar_named_subsections_h

#include <exemplar/prm/assignments.h>

namespace Exemplar
{
  /// Throws UserError if two of the names that Names of a section lists are the same, or if one
  /// holds a sign that means something else in scenes.
  void
  check_names(const std::vector<std::string> &names, const std::string &section);

  /// Throws UnknownKey if `assignments`, which are all in subsections of sections, set something in
  /// a subsection of `section` that is not among the names that its Names lists: as an unknown key
  /// this would have no hint.
  void
  check_listed(const std::vector<Assignment>  &assignments,
               const std::string              &section,
               const std::vector<std::string> &names);
} // namespace Exemplar

#endif
