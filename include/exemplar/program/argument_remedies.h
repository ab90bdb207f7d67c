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
  /// What to say of a command line that is not understood: which word is wrong, and what it was
  /// probably meant to be. `words` are those behind the program's name.
  std::string
  message_of_arguments(const CLI::App                 &app,
                       const CLI::ParseError          &error,
                       const std::vector<std::string> &words);

  /// Throws UserError for a mesh, a directory or a misspelt command, which cannot be run, and says what can.
  void
  require_scene(const std::filesystem::path &file);
} // namespace Exemplar

#endif
