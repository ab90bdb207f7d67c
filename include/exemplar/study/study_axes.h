// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_study_axes_h
#define exemplar_study_axes_h

#include <exemplar/prm/assignments.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Keys that change together, and the values that they take.
  struct StudyAxis
  {
    std::vector<std::string>              keys;   ///< "Section/Key"
    std::vector<std::vector<std::string>> values; ///< in each a value a key

    /// The keys, or the values of one choice, in one piece of text.
    std::string
    name() const;
    std::string
    text(unsigned int choice) const;
  };

  /// Settings "Section/Key=value; ...", which stand at a place of the file. Throws UserError that
  /// names the place.
  std::vector<Assignment>
  parse_settings(const std::string &text, const std::string &place);

  /// Axes "Section/Key: values | Key + Key: value + value, ...", likewise.
  std::vector<StudyAxis>
  parse_axes(const std::string &text, const std::string &place);
} // namespace Exemplar

#endif
