// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_geo_tokens_h
#define exemplar_geo_tokens_h

#include <memory>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Where something stands in a script.
  struct GeoOrigin
  {
    std::shared_ptr<const std::string> file;
    unsigned int                       line; ///< from 1
  };

  /// A piece of a script.
  struct GeoToken
  {
    /// What a piece is.
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
    bool        after_gap; ///< whether blanks or comments stand between it and the one before
  };

  /// Take a script apart as gmsh does, without its comments. `name` stands for it in messages.
  /// Throws UserError for what gmsh might read in another way than this does: strings that do not
  /// end on their line, are longer than gmsh's 1023 bytes or hold a word that ends a skipped part,
  /// and control characters.
  std::vector<GeoToken>
  tokens_of_geo(const std::string &text, const std::string &name);

  /// Throws UserError with the remedies, for what stands somewhere and could run a program or
  /// write a file.
  [[noreturn]] void
  refuse_geo(const GeoOrigin &origin, const std::string &what);
} // namespace Exemplar

#endif
