// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_nearest_word_h
#define exemplar_nearest_word_h

#include <cstddef>
#include <string>
#include <vector>

namespace Exemplar
{
  /// How many letters must be changed, left out, added or exchanged with their neighbour to make
  /// one word of another; capitals count as small letters.
  std::size_t
  edit_distance(const std::string &a, const std::string &b);

  /// Whether a word may be another one mistyped: about one letter in three.
  bool
  is_near(const std::string &word, const std::string &other);

  /// The one of `words` that `word` was probably meant to be; empty if none is near.
  std::string
  nearest_word(const std::string &word, const std::vector<std::string> &words);
} // namespace Exemplar

#endif
