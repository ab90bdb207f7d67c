// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_message_text_h
#define exemplar_message_text_h

#include <string>
#include <string_view>
#include <vector>

// Text for messages, which quote users and their files: any bytes.

namespace Exemplar
{
  /// Position of the first unprintable byte: no UTF-8, or a control character other than a
  /// tabulator; npos if there is none.
  std::size_t
  find_unprintable(std::string_view text);

  /// Any bytes as UTF-8 without control characters: invalid bytes become \x and two digits.
  std::string
  printable(std::string_view bytes);

  /// A word in quotes, printable and of a few characters at most.
  std::string
  in_quotes(std::string_view word);

  /// Words with a separator between them.
  std::string
  joined(const std::vector<std::string> &words, std::string_view separator = ", ");

  /// A message in the form to be shown: printable, without the middle of texts longer than a
  /// screen, and in one paragraph except for lists, whose lines begin with two blanks.
  std::string
  message_text(std::string_view message);
} // namespace Exemplar

#endif
