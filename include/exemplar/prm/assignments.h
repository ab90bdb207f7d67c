// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_assignments_h
#define exemplar_assignments_h

#include <exemplar/base/words.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace Exemplar
{
  /// "set KEY = VALUE" at its place in a file, or a --set of the command line.
  struct Assignment
  {
    std::vector<std::string> subsections;
    std::string              key;
    std::string              value;
    std::string              place; ///< "scene.prm:12" or "--set"

    /// "Section/Key", as --set and messages write it.
    std::string
    path() const;
  };

  /// The bytes of a .prm file. Throws UserError if it cannot be read.
  std::string
  read_prm(const std::filesystem::path &file);

  /// All assignments in the text of a .prm file in order, checked for syntax only: `subsection`
  /// and `end` match, no key is set twice. Throws UserError with file and line. `sections` are
  /// names of subsections that lie in no other: they tell which one lacks its `end`.
  std::vector<Assignment>
  read_assignments(const std::string           &prm_text,
                   const std::string           &file,
                   const std::set<std::string> &sections = {});

  /// "Section/Subsection/Key=value"; `place` is the assignment's.
  Assignment
  parse_assignment(const std::string &text, const std::string &place);

  /// The same from a --set of the command line.
  Assignment
  parse_override(const std::string &text);

  /// The value that `path` ("Section/Key") gets last, or nullptr.
  const Assignment *
  find_assignment(const std::vector<Assignment> &assignments, const std::string &path);

  /// Whether a .prm is a study: it sets Vary. Throws UserError if it cannot be read.
  bool
  is_study(const std::filesystem::path &file);
} // namespace Exemplar

#endif
