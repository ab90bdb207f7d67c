// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_scanner_h
#define exemplar_surface_scanner_h

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace Exemplar
{
  /// All bytes of a file. Throws UserError for one that cannot be read.
  std::string
  read_surface_bytes(const std::filesystem::path &file);

  /// Takes a file of a surface apart: lines of words, or binary numbers. It knows where it is, so
  /// that every complaint names the line or byte. All reading functions throw UserError.
  class SurfaceScanner
  {
  public:
    explicit SurfaceScanner(const std::filesystem::path &file);

    /// Go to the next line that has words; false at the end of the file. A word ends at white
    /// space. With `continued`, a backslash at a line's end joins the next line to it.
    bool
    next_line(bool continued = false);

    /// The words of the line that next_line() went to.
    const std::vector<std::string_view> &
    words() const
    {
      return line_words;
    }

    /// All words of the line from the i-th on, with the white space between them.
    std::string
    rest_of_line(std::size_t i) const;

    /// The number of the line that next_line() went to, from 1.
    std::size_t
    line() const
    {
      return line_number;
    }

    /// The i-th word of the line as a number: finite, unless the word says otherwise.
    double
    number(std::size_t i) const;

    /// A word of the line as a whole number of `long long`.
    long long
    integer(std::string_view word) const;

    /// Switch to binary: from here on messages name bytes, and raw() swaps the byte order if
    /// `swapped_bytes`.
    void
    begin_binary(bool swapped_bytes);

    /// The next bytes as a number; `Number` has 1, 2, 4 or 8 of them.
    template <typename Number>
    Number
    raw();

    std::size_t
    n_bytes_left() const
    {
      return bytes.size() - position;
    }

    /// The whole file.
    std::string_view
    all() const
    {
      return bytes;
    }

    /// Go to a byte of the file, from 0.
    void
    go_to(std::size_t byte)
    {
      position = byte;
    }

    /// Begin to read `n_total` things called `what`, for messages of a truncated file.
    void
    begin_count(std::size_t n_total, const std::string &what);

    /// One more of the things of begin_count() is read.
    void
    count()
    {
      ++n_done;
    }

    /// Throw UserError: file, line or byte; then `message`.
    [[noreturn]] void
    fail(const std::string &message) const;

    /// Throw UserError as fail() does, but for another line of the file.
    [[noreturn]] void
    fail_at_line(std::size_t line, const std::string &message) const;

    /// Throw UserError for a file that is truncated.
    [[noreturn]] void
    fail_at_end() const;

  private:
    void
    read_raw(char *number, std::size_t size);

    std::filesystem::path         file;
    std::string                   bytes;
    std::size_t                   position    = 0;
    std::size_t                   line_number = 0; ///< number of the line of `line_words`
    std::size_t                   n_lines     = 0; ///< lines that were read
    std::vector<std::string_view> line_words;
    bool                          binary  = false;
    bool                          swapped = false;
    std::string                   counted;
    std::size_t                   n_total = 0;
    std::size_t                   n_done  = 0;
  };

  template <typename Number>
  Number
  SurfaceScanner::raw()
  {
    Number value;
    read_raw(reinterpret_cast<char *>(&value), sizeof(Number));
    return value;
  }
} // namespace Exemplar

#endif
