// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_selection_words_h
#define exemplar_selection_words_h

#include <string>
#include <vector>

// How a Selection is written.

namespace Exemplar
{
  /// The first word of a selection, and what follows it.
  struct SelectionWords
  {
    std::string kind;
    std::string rest;
  };

  SelectionWords
  split_selection(const std::string &text);

  /// All that are allowed, for messages.
  extern const std::string selection_forms;

  /// The n numbers behind the kind. Throws UserError with the remedy, calling the selection `key`.
  std::vector<double>
  selection_numbers(const SelectionWords &words, unsigned int n, const std::string &key);

  /// What to say of a selection that is none: begins with a blank, or is empty.
  std::string
  remedy_of_selection(const SelectionWords &words);
} // namespace Exemplar

#endif
