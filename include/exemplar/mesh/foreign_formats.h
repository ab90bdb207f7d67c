// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_foreign_formats_h
#define exemplar_foreign_formats_h

#include <filesystem>
#include <string>
#include <string_view>

namespace Exemplar
{
  /// What a file is that is no .msh, by its first bytes or else by the end of its name, and how to
  /// make a mesh of it that can be read. Sentences; empty if neither tells.
  std::string
  remedy_of_mesh(const std::filesystem::path &file, std::string_view bytes);

  /// The same of a file that is none of the surfaces that can be read.
  std::string
  remedy_of_surface(const std::filesystem::path &file, std::string_view bytes);

  /// The same of a file that is called like a surface, if its bytes are of another format.
  std::string
  remedy_of_content(const std::filesystem::path &surface, std::string_view bytes);
} // namespace Exemplar

#endif
