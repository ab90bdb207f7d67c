// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_kept_file_h
#define exemplar_kept_file_h

#include <filesystem>
#include <functional>
#include <string>

namespace Exemplar
{
  /// A file that takes long to make, kept sealed in $XDG_CACHE_HOME/exemplar or ~/.cache/exemplar
  /// under `name`, which is to say all that it follows from (a digest). Unless it is there and
  /// whole, or if `anew`, `make` writes it, to a path in an empty directory that is removed
  /// afterwards. It appears whole or not at all: several processes may make it at once. Throws
  /// UserError if there is no place to keep it.
  std::filesystem::path
  kept_file(const std::string                                        &name,
            bool                                                      anew,
            const std::function<void(const std::filesystem::path &)> &make);
} // namespace Exemplar

#endif
