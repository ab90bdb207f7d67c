// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_declared_options_h
#define exemplar_declared_options_h

#include <exemplar/base/nearest_word.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <string>
#include <vector>

// What messages on the command lines of programs need to know about the options.

namespace Exemplar
{
  /// The options of a command, as "--NAME".
  inline std::vector<std::string>
  declared_options(const CLI::App &command)
  {
    std::vector<std::string> options;
    for (const CLI::Option *option : command.get_options())
      for (const std::string &name : option->get_lnames())
        options.push_back("--" + name);
    return options;
  }

  /// The one of `options` that an unknown one probably means, such as --output for -o or --out;
  /// empty if there is none.
  inline std::string
  suggested_option(const std::string &unknown, const std::vector<std::string> &options)
  {
    const std::string name
        = unknown.substr(std::min(unknown.find_first_not_of('-'), unknown.size()));
    if (!name.empty() && name != unknown)
      for (const std::string &option : options)
        if (option.compare(2, name.size(), name) == 0)
          return option;
    return nearest_word(unknown, options);
  }
} // namespace Exemplar

#endif
