// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_digest_h
#define exemplar_digest_h

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

struct evp_md_ctx_st; // OpenSSL's

namespace Exemplar
{
  /// SHA-256 of bytes that come one after the other.
  class Sha256
  {
  public:
    Sha256();

    void
    update(const char *data, std::size_t size);

    /// 64 hexadecimal digits. To be called once, after all updates.
    std::string
    hex_digest();

  private:
    std::unique_ptr<evp_md_ctx_st, void (*)(evp_md_ctx_st *)> context;
  };

  /// SHA-256 of a file's bytes, as 64 hexadecimal digits (what `sha256sum`
  /// prints). Throws UserError if the file cannot be read.
  std::string
  sha256(const std::filesystem::path &file);

  /// SHA-256 of the bytes of `text`.
  std::string
  sha256_of_text(const std::string &text);

  /// SHA-256 of the first `n_bytes` of a file. Throws UserError if it cannot be read or has fewer.
  std::string
  sha256_of_begin(const std::filesystem::path &file, std::uintmax_t n_bytes);
} // namespace Exemplar

#endif
