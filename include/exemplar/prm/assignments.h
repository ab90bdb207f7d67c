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
  /// An assignment "set KEY = VALUE" in a file, or a --set of the command line, with its place.
  struct Assignment
  {
    std::vector<std::string> subsections;
    std::string              key;
    std::string              value;
    std::string              place; ///< "scene.prm:12" or "--set"

    /// "Section/Key", as in --set and in messages.
    std::string
    path() const;
  };

  /// The bytes of a .prm file. Throws UserError if it cannot be read.
  std::string
  read_prm(const std::filesystem::path &file);

  /// All assignments in the text of a .prm file in order. Only the syntax is checked: `subsection`
  /// and `end` match, no key is set twice. Throws UserError with file and line. `sections` are
  /// names of outermost subsections, by which a missing `end` is located.
  std::vector<Assignment>
  read_assignments(const std::string           &prm_text,
                   const std::string           &file,
                   const std::set<std::string> &sections = {});

  /// Parse "Section/Subsection/Key=value"; `place` is where it stands.
  Assignment
  parse_assignment(const std::string &text, const std::string &place);

  /// Parse a --set of the command line.
  Assignment
  parse_override(const std::string &text);

  /// The last assignment to `path` ("Section/Key"), or nullptr.
  const Assignment *
  find_assignment(const std::vector<Assignment> &assignments, const std::string &path);

  /// Whether a .prm is a study: it sets Vary. Throws UserError if it cannot be read.
  bool
  is_study(const std::filesystem::path &file);
} // namespace Exemplar

#endif
