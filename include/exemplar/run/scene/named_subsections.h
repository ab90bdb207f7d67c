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

  /// Of `named`, which are all in subsections of sections, take out those in a subsection of `section` that
  /// is not among the names that its Names lists, and return a warning of each such subsection. Throws
  /// UnknownKey for one that `overrides` set, where `others` do not set Names at all, and for one that may be
  /// a listed name without a subsection, misspelt.
  std::vector<std::string>
  drop_unlisted(std::vector<Assignment>        &named,
                const std::vector<Assignment>  &others,
                const std::vector<Assignment>  &overrides,
                const std::string              &section,
                const std::vector<std::string> &names);
} // namespace Exemplar

#endif
