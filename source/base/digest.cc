// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/digest.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/text_file.h>

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace Exemplar
{
  namespace
  {
    /// OpenSSL fails only if it is broken itself.
    void
    require(const bool success)
    {
      if (!success)
        throw std::runtime_error("OpenSSL cannot compute SHA-256 on this machine.");
    }

    [[noreturn]] void
    throw_unreadable(const std::filesystem::path &file, const std::string &reason)
    {
      throw UserError(file.string() + ": cannot be read (" + reason + ").");
    }

    /// SHA-256 of a file, or of its first bytes if `n_bytes` is given.
    std::string
    digest_of(const std::filesystem::path &file, const std::uintmax_t *n_bytes)
    {
      if (const std::string reason = reason_not_to_read(file); !reason.empty())
        throw_unreadable(file, reason);
      errno = 0;
      std::ifstream in(file, std::ios::binary);
      if (!in)
        throw_unreadable(file, std::strerror(errno));

      Sha256                    digest;
      std::array<char, 1 << 16> buffer;
      std::uintmax_t            left = n_bytes != nullptr ? *n_bytes : UINTMAX_MAX;
      while (in && left > 0)
      {
        in.read(buffer.data(),
                static_cast<std::streamsize>(std::min<std::uintmax_t>(left, buffer.size())));
        const auto n_read = static_cast<std::size_t>(in.gcount());
        digest.update(buffer.data(), n_read);
        left -= n_read;
      }

      if (in.bad() || (n_bytes != nullptr ? left > 0 : !in.eof()))
        throw_unreadable(file, errno != 0 ? std::strerror(errno) : "it is too short");
      return digest.hex_digest();
    }
  } // namespace

  Sha256::Sha256() : context(EVP_MD_CTX_new(), &EVP_MD_CTX_free)
  {
    require(context != nullptr && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1);
  }

  void
  Sha256::update(const char *data, const std::size_t size)
  {
    require(EVP_DigestUpdate(context.get(), data, size) == 1);
  }

  std::string
  Sha256::hex_digest()
  {
    std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
    unsigned int                               n_bytes = 0;
    require(EVP_DigestFinal_ex(context.get(), bytes.data(), &n_bytes) == 1);
    std::string text;
    for (unsigned int i = 0; i < n_bytes; ++i)
    {
      text += "0123456789abcdef"[bytes[i] / 16];
      text += "0123456789abcdef"[bytes[i] % 16];
    }
    return text;
  }

  std::string
  sha256(const std::filesystem::path &file)
  {
    return digest_of(file, nullptr);
  }

  std::string
  sha256_of_text(const std::string &text)
  {
    Sha256 digest;
    digest.update(text.data(), text.size());
    return digest.hex_digest();
  }

  std::string
  sha256_of_begin(const std::filesystem::path &file, const std::uintmax_t n_bytes)
  {
    return digest_of(file, &n_bytes);
  }
} // namespace Exemplar
