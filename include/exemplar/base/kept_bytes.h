// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_kept_bytes_h
#define exemplar_kept_bytes_h

#include <functional>
#include <string>

namespace Exemplar
{
  /// What kept_bytes() has found or made.
  struct KeptBytes
  {
    std::string bytes;
    std::string warning; ///< why it was made and not kept, and the remedy; empty if it is kept
  };

  /// Bytes that take long to make, kept in a sealed file of $XDG_CACHE_HOME/exemplar or
  /// ~/.cache/exemplar under `name`, which is to say all that they follow from (a digest). Unless
  /// they are there and whole, `make` makes them. The file appears whole or not at all: several
  /// processes may make it at once. Where they cannot be kept, or where others may write, nothing
  /// is read and nothing kept.
  KeptBytes
  kept_bytes(const std::string &name, const std::function<std::string()> &make);
} // namespace Exemplar

#endif
