// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_argument_remedies_h
#define exemplar_argument_remedies_h

#include <filesystem>
#include <string>
#include <vector>

namespace CLI
{
  class App;
  class ParseError;
} // namespace CLI

namespace Exemplar
{
  /// Message on an invalid command line: the wrong word, and its likely meaning. `words` are those
  /// after the program's name.
  std::string
  message_of_arguments(const CLI::App                 &app,
                       const CLI::ParseError          &error,
                       const std::vector<std::string> &words);

  /// Throws UserError, with a remedy, if `file` is a mesh, a directory or a misspelt command
  /// instead of a scene.
  void
  require_scene(const std::filesystem::path &file);
} // namespace Exemplar

#endif
