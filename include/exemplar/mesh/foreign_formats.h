// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_foreign_formats_h
#define exemplar_foreign_formats_h

#include <filesystem>
#include <string>
#include <string_view>

namespace Exemplar
{
  /// Advice on a file that is no .msh: its format, by its first bytes or else by its extension, and
  /// how to convert it to a mesh that can be read. Sentences; empty for an unknown format.
  std::string
  remedy_of_mesh(const std::filesystem::path &file, std::string_view bytes);

  /// Advice on a file that is none of the surfaces that can be read, as remedy_of_mesh().
  std::string
  remedy_of_surface(const std::filesystem::path &file, std::string_view bytes);

  /// Advice on a file with the extension of a surface, if its bytes are of another format, as
  /// remedy_of_mesh().
  std::string
  remedy_of_content(const std::filesystem::path &surface, std::string_view bytes);
} // namespace Exemplar

#endif
