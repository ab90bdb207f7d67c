// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_kept_bytes_h
#define exemplar_kept_bytes_h

#include <functional>
#include <string>

namespace Exemplar
{
  /// Result of kept_bytes().
  struct KeptBytes
  {
    std::string bytes;
    std::string warning; ///< why it is made and not kept, with advice; empty if it is kept
  };

  /// A cache of bytes that take long to make, in sealed files of $XDG_CACHE_HOME/exemplar or
  /// ~/.cache/exemplar. `name` identifies all inputs of the bytes (a digest). Unless the file
  /// exists and is undamaged, `make` makes the bytes. Files appear whole or not at all: several
  /// processes may make one at once. Where the directory cannot be used, or others may write to it,
  /// nothing is read and nothing kept.
  KeptBytes
  kept_bytes(const std::string &name, const std::function<std::string()> &make);
} // namespace Exemplar

#endif
