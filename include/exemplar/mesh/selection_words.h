// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_selection_words_h
#define exemplar_selection_words_h

#include <string>
#include <vector>

// The syntax of a Selection.

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

  /// All allowed forms, for messages.
  extern const std::string selection_forms;

  /// The n numbers after the kind. Throws UserError with advice, calling the selection `key`.
  std::vector<double>
  selection_numbers(const SelectionWords &words, unsigned int n, const std::string &key);

  /// Advice on an invalid selection: begins with a blank, or is empty.
  std::string
  remedy_of_selection(const SelectionWords &words);
} // namespace Exemplar

#endif
