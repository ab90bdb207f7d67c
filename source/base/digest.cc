// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/digest.h>
#include <exemplar/base/errors.h>

#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>

namespace Exemplar
{
  namespace
  {
    /// OpenSSL's digest context; fails only if OpenSSL itself is broken.
    class Sha256
    {
    public:
      Sha256() : context(EVP_MD_CTX_new(), &EVP_MD_CTX_free)
      {
        require(context != nullptr && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1);
      }

      void
      update(const char *data, const std::size_t size)
      {
        require(EVP_DigestUpdate(context.get(), data, size) == 1);
      }

      std::string
      hex_digest()
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

    private:
      static void
      require(const bool success)
      {
        if (!success)
          throw std::runtime_error("OpenSSL cannot compute SHA-256 on this machine.");
      }

      std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context;
    };

    [[noreturn]] void
    throw_unreadable(const std::filesystem::path &file)
    {
      throw UserError(file.string() + ": cannot be read (" + std::strerror(errno) + ").");
    }
  } // namespace

  std::string
  sha256(const std::filesystem::path &file)
  {
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    if (!in)
      throw_unreadable(file);

    Sha256                    digest;
    std::array<char, 1 << 16> buffer;
    do
    {
      in.read(buffer.data(), buffer.size());
      digest.update(buffer.data(), static_cast<std::size_t>(in.gcount()));
    } while (in);

    // A directory opens, but does not read.
    if (in.bad() || !in.eof())
      throw_unreadable(file);
    return digest.hex_digest();
  }

  std::string
  sha256_of_text(const std::string &text)
  {
    Sha256 digest;
    digest.update(text.data(), text.size());
    return digest.hex_digest();
  }
} // namespace Exemplar
