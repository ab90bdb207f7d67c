// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/mesh/foreign_formats.h>
#include <exemplar/mesh/msh_scanner.h>

#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace Exemplar
{
  namespace
  {
    bool
    is_space(const char c)
    {
      return c == ' ' || c == '\n' || c == '\r' || c == '\t';
    }
  } // namespace

  MshScanner::MshScanner(std::string all_bytes, const std::string &name)
      : file(name), bytes(std::move(all_bytes))
  {
    if (const std::string mark = "\xEF\xBB\xBF"; bytes.compare(0, mark.size(), mark) == 0)
      position = mark.size(); // byte order mark of UTF-8
    if (bytes.compare(position, 1, "$") == 0)
      return;
    if (const std::string remedy = remedy_of_mesh(file, bytes); !remedy.empty())
      throw UserError(file.string() + " is no gmsh .msh file. " + remedy);
  }

  void
  MshScanner::set_binary(const bool binary_numbers)
  {
    binary = binary_numbers;
  }

  bool
  MshScanner::at_end()
  {
    while (position < bytes.size() && is_space(bytes[position]))
      ++position;
    return position == bytes.size();
  }

  std::string
  MshScanner::begin_section()
  {
    section.clear();
    counted.clear();
    const std::string_view word = text_word();
    if (word.size() < 2 || word[0] != '$')
      fail_expected("a section such as $Nodes", word);
    section = word.substr(1);
    return section;
  }

  void
  MshScanner::end_section()
  {
    const std::string_view word = text_word();
    if (word != "$End" + section)
      fail_expected("$End" + section, word);
    section.clear();
    counted.clear();
  }

  void
  MshScanner::skip_section()
  {
    const std::string end   = "$End" + section;
    const std::size_t found = bytes.find(end, position);
    if (found == std::string::npos)
      fail_at_end();
    position = found + end.size();
    section.clear();
  }

  std::string_view
  MshScanner::text_word()
  {
    if (at_end())
      fail_at_end();
    const std::size_t begin = position;
    while (position < bytes.size() && !is_space(bytes[position]))
      ++position;
    return std::string_view(bytes).substr(begin, position - begin);
  }

  template <typename Number>
  Number
  MshScanner::parse_integer()
  {
    const std::string_view word  = text_word();
    const char *const      end   = word.data() + word.size();
    Number                 value = 0;
    const auto             done  = std::from_chars(word.data(), end, value);
    if (done.ec != std::errc() || done.ptr != end)
      fail_expected("an integer", word);
    return value;
  }

  int
  MshScanner::text_int()
  {
    return parse_integer<int>();
  }

  std::size_t
  MshScanner::text_size()
  {
    return parse_integer<std::size_t>();
  }

  std::string
  MshScanner::text_quoted()
  {
    const std::size_t end = bytes.find('\n', position);
    if (end == std::string::npos)
      fail_at_end();
    const std::string_view line  = std::string_view(bytes).substr(position, end - position);
    const std::size_t      first = line.find('"');
    const std::size_t      last  = line.rfind('"');
    if (first == last)
      fail_expected("a name in quotation marks", line);
    position = end;
    return std::string(line.substr(first + 1, last - first - 1));
  }

  void
  MshScanner::end_line()
  {
    while (position < bytes.size() && bytes[position] != '\n')
      if (!is_space(bytes[position++]))
        fail("a line is longer than it should be.");
    if (position == bytes.size())
      fail_at_end();
    ++position;
  }

  template <typename Number>
  Number
  MshScanner::raw()
  {
    if (n_bytes_left() < sizeof(Number))
      fail_at_end();
    Number value;
    std::memcpy(&value, bytes.data() + position, sizeof(Number));
    position += sizeof(Number);
    return value;
  }

  int
  MshScanner::read_int()
  {
    return binary ? raw<int>() : text_int();
  }

  std::size_t
  MshScanner::read_size()
  {
    return binary ? raw<std::size_t>() : text_size();
  }

  std::size_t
  MshScanner::read_int_as_size()
  {
    const int value = read_int();
    if (value < 0)
      fail(fmt::format("expected a count or number >= 0, found {}.", value));
    return static_cast<std::size_t>(value);
  }

  double
  MshScanner::read_double()
  {
    if (binary)
      return raw<double>();

    const std::string_view word  = text_word();
    const std::size_t      plus  = (word[0] == '+') ? 1 : 0; // from_chars accepts no plus
    const char *const      begin = word.data() + plus;
    const char *const      end   = word.data() + word.size();
    double                 value = 0.;
    auto                   done  = std::from_chars(begin, end, value);
    if (done.ec == std::errc::result_out_of_range)
      value = std::strtod(begin, nullptr); // distinguishes too small (0) from too large (infinite)
    else if (done.ec != std::errc())
      done.ptr = nullptr;
    if (done.ptr != end)
      fail_expected("a number", word);
    return value;
  }

  void
  MshScanner::begin_count(const std::size_t total, const std::string &what)
  {
    n_total = total;
    n_done  = 0;
    counted = what;
  }

  std::string
  MshScanner::place() const
  {
    std::string text;
    if (!section.empty())
      text += " within section $" + section;
    if (!counted.empty())
      text += fmt::format(" after {} of {} {}", n_done, n_total, counted);
    return text;
  }

  void
  MshScanner::fail(const std::string &message) const
  {
    const std::string where = place();
    throw UserError(file.string() + ":" + where + (where.empty() ? " " : ": ") + message);
  }

  void
  MshScanner::fail_expected(const std::string &expected, const std::string_view found) const
  {
    // No complete file ends with a wrong word: this one is truncated.
    if (position == bytes.size() && bytes.find('$') != std::string::npos)
      fail_at_end();
    fail("expected " + expected + ", found " + in_quotes(found)
         + (section.empty() && counted.empty()
                ? ". A gmsh .msh file of version 2.2 or 4.1 consists of such sections: save or "
                  "convert the mesh by gmsh FILE -save -format msh22 -o NEW.msh."
                : ". Is the file whole, and copied in binary mode? Save the mesh anew."));
  }

  void
  MshScanner::fail_at_end() const
  {
    throw UserError(file.string() + ": ends" + place()
                    + "; the file is truncated. Copy it again, or save the mesh anew.");
  }
} // namespace Exemplar
