// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_geo_script_h
#define exemplar_geo_script_h

#include <memory>
#include <string>
#include <vector>

// A .geo file is a program for gmsh: it may run others, and write files anywhere.

namespace Exemplar
{
  /// A position in a script.
  struct GeoOrigin
  {
    std::shared_ptr<const std::string> file;
    unsigned int                       line; ///< from 1
  };

  /// A token of a script.
  struct GeoToken
  {
    /// Kind of a token.
    enum class Kind
    {
      word,
      text, ///< a string, with its quotes
      number,
      sign
    };

    Kind        kind;
    std::string text;
    GeoOrigin   origin;
    bool        after_gap; ///< whether blanks or comments precede it
  };

  /// Split a script into tokens as gmsh does, without its comments. `name` stands for it in
  /// messages. Throws UserError for text that gmsh might read differently: strings that do not end
  /// on their line, are longer than gmsh's 1023 bytes or hold a word that ends a skipped part, and
  /// control characters.
  std::vector<GeoToken>
  tokens_of_geo(const std::string &text, const std::string &name);

  /// Throws UserError with advice, for `what` at this position, which could run a program or write
  /// a file.
  [[noreturn]] void
  refuse_geo(const GeoOrigin &origin, const std::string &what);

  /// Throws UserError if a script, whose inclusions have been resolved, could run a program, write
  /// a file or read another one: for any word by which gmsh does that.
  void
  check_geo(const std::vector<GeoToken> &script);

  /// Whether the word at a place is a command, not a variable or an option of this name.
  bool
  is_geo_command(const std::vector<GeoToken> &script, std::size_t place);

  /// The token at a place; a sign of no text behind the end.
  const GeoToken &
  geo_token(const std::vector<GeoToken> &script, std::size_t place);
} // namespace Exemplar

#endif
