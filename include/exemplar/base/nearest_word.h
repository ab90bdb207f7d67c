// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_nearest_word_h
#define exemplar_nearest_word_h

#include <cstddef>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Edit distance of two words: the number of letters to be changed, left out, added or exchanged
  /// with their neighbour; capitals count as small letters.
  std::size_t
  edit_distance(const std::string &a, const std::string &b);

  /// Whether a word may be another one misspelt: about one letter in three.
  bool
  is_near(const std::string &word, const std::string &other);

  /// The one of `words` that `word` probably means; empty if none is near.
  std::string
  nearest_word(const std::string &word, const std::vector<std::string> &words);
} // namespace Exemplar

#endif
