// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_text_h
#define exemplar_mesh_text_h

#include <string>
#include <string_view>
#include <vector>

namespace Exemplar
{
  /// Takes the text of a mesh apart into words, each a run of characters that are neither white
  /// space nor separators. Lines may end in LF, CR LF or CR. Every message names file and line. All
  /// reading functions throw UserError.
  class MeshText
  {
  public:
    /// `separators` part words as white space does; a `comment` character begins a comment, to the
    /// end of its line (none: no comments). `name` stands for the file in messages.
    MeshText(std::string        bytes,
             const std::string &name,
             const std::string &separators = "",
             char               comment    = '\0');

    /// Skip white space, separators and comments; returns whether nothing else is left.
    bool
    at_end();

    /// The next word; at the end of the file the message says that `what` is missing.
    std::string_view
    word(const std::string &what);

    /// The next word as a finite number, and as a whole one.
    double
    number(const std::string &what);
    long long
    integer(const std::string &what);

    /// The next word as a count or index, from 0.
    std::size_t
    size(const std::string &what);

    /// The next word as a count of items that take at least one byte each, which the rest of the
    /// file must have.
    std::size_t
    count(const std::string &what);

    /// A word of this file as a number.
    double
    number_of(std::string_view word, const std::string &what) const;
    long long
    integer_of(std::string_view word, const std::string &what) const;

    /// The rest of this line, without its end; goes to the next line.
    std::string_view
    rest_of_line();

    /// The next `n` bytes.
    std::string_view
    raw(std::size_t n, const std::string &what);

    std::size_t
    n_bytes_left() const
    {
      return bytes.size() - position;
    }

    const std::string &
    get_name() const
    {
      return name;
    }

    /// Throw UserError: file, line of the last word, message.
    [[noreturn]] void
    fail(const std::string &message) const;

    /// Throw UserError for a file that ends before `what`.
    [[noreturn]] void
    fail_at_end(const std::string &what) const;

  private:
    bool
    is_gap(char c) const;

    void
    go_on();

    std::string name, bytes, separators;
    char        comment;
    std::size_t position = 0, line = 1;
    std::size_t line_of_word = 1;
  };

  /// Words of a text between `separators` and white space.
  std::vector<std::string_view>
  words_of(std::string_view text, const std::string &separators = "");

  std::string
  in_capitals(std::string_view text);
} // namespace Exemplar

#endif
