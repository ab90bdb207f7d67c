// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_message_text_h
#define exemplar_message_text_h

#include <string>
#include <string_view>
#include <vector>

// Messages quote what users and their files hold, which may be any bytes.

namespace Exemplar
{
  /// The first byte that is no text for people: no UTF-8, or a control character other than a
  /// tabulator; npos if there is none.
  std::size_t
  find_unprintable(std::string_view text);

  /// Any bytes as UTF-8 without control characters: bytes that are none become \x and two digits.
  std::string
  printable(std::string_view bytes);

  /// A word in quotes, printable and of a few characters at most.
  std::string
  in_quotes(std::string_view word);

  /// Words with a separator between them.
  std::string
  joined(const std::vector<std::string> &words, std::string_view separator = ", ");

  /// A message as it may be shown: printable, without the middle of what is longer than a screen,
  /// and in one paragraph but for lists, whose lines begin with two blanks.
  std::string
  message_text(std::string_view message);
} // namespace Exemplar

#endif
