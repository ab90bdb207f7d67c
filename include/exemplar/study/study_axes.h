// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_study_axes_h
#define exemplar_study_axes_h

#include <exemplar/prm/assignments.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Keys that vary together, and their values.
  struct StudyAxis
  {
    std::vector<std::string>              keys;   ///< "Section/Key"
    std::vector<std::vector<std::string>> values; ///< for each choice, a value a key

    /// The keys, or the values of one choice, as one text.
    std::string
    name() const;
    std::string
    text(unsigned int choice) const;
  };

  /// Parse settings "Section/Key=value; ..." at a place in a file. Throws UserError with the place.
  std::vector<Assignment>
  parse_settings(const std::string &text, const std::string &place);

  /// Parse axes "Section/Key: values | Key + Key: value + value, ...". Throws UserError with the
  /// place.
  std::vector<StudyAxis>
  parse_axes(const std::string &text, const std::string &place);
} // namespace Exemplar

#endif
