// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/mesh/mesh_text.h>

#include <fmt/core.h>

#include <algorithm>
#include <cctype>

namespace Exemplar
{
  namespace
  {
    const std::string white_space(" \t\r\n\f\v\0", 7);

    /// A word, cut for a message.
    std::string
    shown(const std::string_view word)
    {
      return in_quotes(std::string(word.substr(0, 40)) + (word.size() > 40 ? "..." : ""));
    }
  } // namespace

  MeshText::MeshText(std::string        text,
                     const std::string &name,
                     const std::string &separators,
                     const char         comment)
      : name(name), bytes(std::move(text)), separators(separators), comment(comment)
  {
  }

  bool
  MeshText::is_gap(const char c) const
  {
    return white_space.find(c) != std::string::npos || separators.find(c) != std::string::npos;
  }

  void
  MeshText::go_on()
  {
    const char c = bytes[position++];
    if (c == '\n' || (c == '\r' && (position == bytes.size() || bytes[position] != '\n')))
      ++line;
  }

  bool
  MeshText::at_end()
  {
    for (; position < bytes.size(); go_on())
      if (comment != '\0' && bytes[position] == comment)
        position = std::min(bytes.find_first_of("\r\n", position), bytes.size() - 1);
      else if (!is_gap(bytes[position]))
        return false;
    return true;
  }

  std::string_view
  MeshText::word(const std::string &what)
  {
    if (at_end())
      fail_at_end(what);
    line_of_word            = line;
    const std::size_t begin = position;
    while (position < bytes.size() && !is_gap(bytes[position])
           && (comment == '\0' || bytes[position] != comment))
      ++position;
    return std::string_view(bytes).substr(begin, position - begin);
  }

  double
  MeshText::number_of(std::string_view text, const std::string &what) const
  {
    const std::string_view whole = text;
    if (text.size() > 1 && text[0] == '+' && text[1] != '-')
      text.remove_prefix(1);
    if (const auto value = decimal_number<double>(text))
      return *value;
    // from_chars() refuses numbers below the least of full precision, and exponents as Fortran
    // writes them (1.5D-3)
    std::string in_c(text);
    std::replace_if(
        in_c.begin(), in_c.end(), [](const char c) { return c == 'd' || c == 'D'; }, 'e');
    if (const double value = parse_number(in_c);
        std::isfinite(value) && in_c.find_first_not_of("0123456789.eE+-") == std::string::npos)
      return value;
    fail(what + " should be a finite number, found " + shown(whole)
         + ". Save or copy the mesh again.");
  }

  long long
  MeshText::integer_of(const std::string_view text, const std::string &what) const
  {
    if (const auto value = decimal_number<long long>(text))
      return *value;
    fail(what + " should be a whole number, found " + shown(text)
         + ". Save or copy the mesh again.");
  }

  double
  MeshText::number(const std::string &what)
  {
    return number_of(word(what), what);
  }

  long long
  MeshText::integer(const std::string &what)
  {
    return integer_of(word(what), what);
  }

  std::size_t
  MeshText::size(const std::string &what)
  {
    const long long value = integer(what);
    if (value < 0)
      fail(what
           + fmt::format(" is {}, but cannot be negative. Save or copy the mesh again.", value));
    return static_cast<std::size_t>(value);
  }

  std::size_t
  MeshText::count(const std::string &what)
  {
    const std::size_t n = size(what);
    if (n > n_bytes_left())
      fail(
          fmt::format("{} is {}, but the file has only {} bytes left. It is cut off, or the number "
                      "is wrong: save or copy the mesh again.",
                      what, n, n_bytes_left()));
    return n;
  }

  std::string_view
  MeshText::rest_of_line()
  {
    line_of_word            = line;
    const std::size_t begin = position;
    const std::size_t end   = std::min(bytes.find_first_of("\r\n", begin), bytes.size());
    position                = end;
    if (position < bytes.size() && bytes[position] == '\r' && position + 1 < bytes.size()
        && bytes[position + 1] == '\n')
      ++position;
    if (position < bytes.size())
      go_on();
    return std::string_view(bytes).substr(begin, end - begin);
  }

  std::string_view
  MeshText::raw(const std::size_t n, const std::string &what)
  {
    if (n > n_bytes_left())
      fail_at_end(what);
    const std::size_t begin = position;
    position += n;
    return std::string_view(bytes).substr(begin, n);
  }

  void
  MeshText::fail(const std::string &message) const
  {
    throw UserError(fmt::format("{}: line {}: {}", name, line_of_word, message));
  }

  void
  MeshText::fail_at_end(const std::string &what) const
  {
    throw UserError(fmt::format("{}: the file ends at line {} before {}. It is cut off: save or "
                                "copy the mesh again.",
                                name, line, what));
  }

  std::vector<std::string_view>
  words_of(const std::string_view text, const std::string &separators)
  {
    const std::string             gaps = white_space + separators;
    std::vector<std::string_view> words;
    for (std::size_t at = 0; (at = text.find_first_not_of(gaps, at)) < text.size();)
    {
      const std::size_t end = std::min(text.find_first_of(gaps, at), text.size());
      words.push_back(text.substr(at, end - at));
      at = end;
    }
    return words;
  }

  std::string
  in_capitals(const std::string_view text)
  {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](const unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return result;
  }
} // namespace Exemplar
