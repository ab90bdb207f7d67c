// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_digest_h
#define exemplar_digest_h

#include <filesystem>
#include <string>

namespace Exemplar
{
  /// SHA-256 of a file's bytes, as 64 hexadecimal digits (what `sha256sum`
  /// prints). Throws UserError if the file cannot be read.
  std::string
  sha256(const std::filesystem::path &file);

  /// SHA-256 of the bytes of `text`.
  std::string
  sha256_of_text(const std::string &text);
} // namespace Exemplar

#endif
