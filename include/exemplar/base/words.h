// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_words_h
#define exemplar_words_h

#include <cstddef>
#include <string>
#include <vector>

namespace Exemplar
{
  /// A number with its noun, which is in the singular: "1 step", "2 steps".
  std::string
  counted(std::size_t n, const std::string &noun);

  /// The text without blanks at its ends.
  std::string
  trim(const std::string &text);

  bool
  ends_with(const std::string &text, const std::string &end);

  /// Values separated by a sign, such as expressions by ';', without the blanks around them.
  std::vector<std::string>
  split_trimmed(const std::string &text, char separator);
} // namespace Exemplar

#endif
