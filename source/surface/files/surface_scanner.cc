// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/missing_file.h>
#include <exemplar/base/text_file.h>
#include <exemplar/surface/files/surface_scanner.h>

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>

namespace Exemplar
{
  namespace
  {
    bool
    is_blank(const char c)
    {
      return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
    }

    /// Lines end by \n, \r\n or, as once on the Macintosh, \r.
    std::size_t
    end_of_line(const std::string &bytes, const std::size_t begin)
    {
      return std::min(bytes.find_first_of("\r\n", begin), bytes.size());
    }

    std::size_t
    behind_line_break(const std::string &bytes, const std::size_t end)
    {
      const bool two = bytes.compare(end, 2, "\r\n") == 0;
      return std::min(end + (two ? 2 : 1), bytes.size());
    }
    /// Bytes without the byte order mark that editors put before UTF-8, if they are text: other
    /// files hold bytes that are 0.
    std::string
    without_mark(std::string bytes)
    {
      const std::string mark    = "\xEF\xBB\xBF";
      const bool        is_text = bytes.substr(0, 100).find('\0') == std::string::npos;
      if (is_text && bytes.compare(0, mark.size(), mark) == 0)
        bytes.erase(0, mark.size());
      return bytes;
    }

    /// Whether a text is saved with two bytes a character.
    bool
    is_utf16(const std::string &bytes)
    {
      return bytes.compare(0, 2, "\xFF\xFE") == 0 || bytes.compare(0, 2, "\xFE\xFF") == 0;
    }
  } // namespace

  std::string
  read_surface_bytes(const std::filesystem::path &file)
  {
    std::string reason;
    if (auto bytes = read_text_file(file, &reason))
      return without_mark(std::move(*bytes));
    throw UserError(file.string() + ": cannot be opened (" + reason
                    + "). Give the path of a surface: an .obj, .ply or .stl file."
                    + missing_file_remedy(file));
  }

  SurfaceScanner::SurfaceScanner(const std::filesystem::path &path)
      : file(path), bytes(read_surface_bytes(path))
  {
    if (bytes.empty())
      throw UserError(file.string() + ": the file is empty. Save the surface anew.");
    if (is_utf16(bytes) && file.extension() != ".stl") // binary ones may begin with any bytes
      throw UserError(file.string()
                      + ": the file is saved as UTF-16. Save it as UTF-8 or ASCII, or export the "
                        "surface anew.");
  }

  bool
  SurfaceScanner::next_line(const bool continued)
  {
    line_words.clear();
    while (position < bytes.size())
    {
      if (line_words.empty())
        line_number = n_lines + 1;
      ++n_lines;
      const std::size_t end  = end_of_line(bytes, position);
      std::size_t       last = end;
      const bool        goes_on
          = continued && end > position && bytes[end - 1] == '\\' && end < bytes.size();
      if (goes_on)
        --last;
      for (std::size_t i = position; i < last;)
      {
        const std::size_t begin = i;
        while (i < last && !is_blank(bytes[i]))
          ++i;
        if (i > begin)
          line_words.push_back(std::string_view(bytes).substr(begin, i - begin));
        else
          ++i;
      }
      position = behind_line_break(bytes, end);
      if (!line_words.empty() && !goes_on)
        return true;
    }
    return !line_words.empty();
  }

  std::string
  SurfaceScanner::rest_of_line(const std::size_t i) const
  {
    if (i >= line_words.size())
      return "";
    const char *const end = line_words.back().data() + line_words.back().size();
    return { line_words[i].data(), end };
  }

  double
  SurfaceScanner::number(const std::size_t i) const
  {
    const std::string_view word  = line_words[i];
    const std::size_t      plus  = (word[0] == '+') ? 1 : 0; // from_chars knows no plus
    const char *const      begin = word.data() + plus;
    const char *const      end   = word.data() + word.size();
    double                 value = 0.;
    const auto             done  = std::from_chars(begin, end, value);
    if (done.ptr != end || done.ec == std::errc::invalid_argument)
      fail("expected a number, found " + in_quotes(word) + "."
           + (word.find(',') == std::string_view::npos
                  ? ""
                  : " The decimal sign is a point: export the surface with points."));
    if (done.ec == std::errc::result_out_of_range) // too small (0) or too large (infinite)
      value = std::strtod(std::string(begin, end).c_str(), nullptr);
    return value;
  }

  long long
  SurfaceScanner::integer(const std::string_view word) const
  {
    const std::size_t plus  = (!word.empty() && word[0] == '+') ? 1 : 0;
    const char *const end   = word.data() + word.size();
    long long         value = 0;
    const auto        done  = std::from_chars(word.data() + plus, end, value);
    if (done.ec != std::errc() || done.ptr != end)
      fail("expected an integer, found " + in_quotes(word) + ".");
    return value;
  }

  void
  SurfaceScanner::begin_binary(const bool swapped_bytes)
  {
    binary  = true;
    swapped = swapped_bytes;
  }

  void
  SurfaceScanner::read_raw(char *const number, const std::size_t size)
  {
    if (n_bytes_left() < size)
      fail_at_end();
    std::memcpy(number, bytes.data() + position, size);
    if (swapped)
      std::reverse(number, number + size);
    position += size;
  }

  void
  SurfaceScanner::begin_count(const std::size_t total, const std::string &what)
  {
    n_total = total;
    n_done  = 0;
    counted = what;
  }

  void
  SurfaceScanner::fail(const std::string &message) const
  {
    if (!binary && line_number > 0)
      fail_at_line(line_number, message);
    throw UserError(fmt::format("{}{}: {}", file.string(),
                                binary ? fmt::format(", byte {}", position) : "", message));
  }

  void
  SurfaceScanner::fail_at_line(const std::size_t line, const std::string &message) const
  {
    throw UserError(fmt::format("{}, line {}: {}", file.string(), line, message));
  }

  void
  SurfaceScanner::fail_at_end() const
  {
    throw UserError(
        fmt::format("{}: ends after {} of {} {}; the file is truncated. Save or copy it anew.",
                    file.string(), n_done, n_total, counted));
  }
} // namespace Exemplar
