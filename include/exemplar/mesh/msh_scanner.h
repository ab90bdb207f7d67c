// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_msh_scanner_h
#define exemplar_msh_scanner_h

#include <filesystem>
#include <string>
#include <string_view>

namespace Exemplar
{
  /// Splits a .msh file into sections, numbers and names. It tracks its position, so that every
  /// message says how far the file was valid: "bar.msh: ends within section $Nodes after 17 of 2860
  /// nodes; ...". All reading functions throw UserError.
  class MshScanner
  {
  public:
    /// `name` stands for the file in messages.
    MshScanner(std::string bytes, const std::string &name);

    /// Let the `read_` functions read binary numbers (true) or text from here on.
    void
    set_binary(bool binary);

    bool
    is_binary() const
    {
      return binary;
    }

    /// Skip white space; returns whether nothing else is left.
    bool
    at_end();

    /// The next section's name without the $.
    std::string
    begin_section();

    /// Require $EndNAME of the section begun last.
    void
    end_section();

    /// Skip to the end of $EndNAME of the section begun last.
    void
    skip_section();

    /// Numbers in the file's format. Binary: 4, 8 and 8 bytes.
    int
    read_int();
    std::size_t
    read_size();
    double
    read_double();

    /// An int that counts or numbers something: refuses a negative one.
    std::size_t
    read_int_as_size();

    /// Numbers and names that are text also in a binary file.
    int
    text_int();
    std::size_t
    text_size();
    std::string_view
    text_word();
    /// The text between the first and the last quotation mark of this line.
    std::string
    text_quoted();

    /// Skip the line break, right behind which binary numbers begin.
    void
    end_line();

    /// Announce `n_total` items called `what`, for messages.
    void
    begin_count(std::size_t n_total, const std::string &what);

    /// Count one more item read.
    void
    count()
    {
      ++n_done;
    }

    /// Number of bytes not yet read, a bound for allocations.
    std::size_t
    n_bytes_left() const
    {
      return bytes.size() - position;
    }

    /// Throw UserError with file, section, position and then `message`.
    [[noreturn]] void
    fail(const std::string &message) const;

  private:
    template <typename Number>
    Number
    raw();

    template <typename Number>
    Number
    parse_integer();

    [[noreturn]] void
    fail_expected(const std::string &expected, std::string_view found) const;

    [[noreturn]] void
    fail_at_end() const;

    /// " within section $Nodes after 17 of 2860 nodes"
    std::string
    place() const;

    std::filesystem::path file;
    std::string           bytes;
    std::size_t           position = 0;
    bool                  binary   = false;
    std::string           section;
    std::string           counted;
    std::size_t           n_total = 0;
    std::size_t           n_done  = 0;
  };
} // namespace Exemplar

#endif
