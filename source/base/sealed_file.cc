// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/sealed_file.h>

#include <fstream>
#include <string>

namespace Exemplar
{
  namespace
  {
    std::string
    seal_of(const std::string &digest)
    {
      return "\n$SHA256\n" + digest + "\n$EndSHA256\n";
    }

    /// Size of every seal in bytes.
    const std::uintmax_t seal_size = seal_of(std::string(64, '0')).size();
  } // namespace

  SealingBuffer::int_type
  SealingBuffer::overflow(const int_type c)
  {
    const char byte = traits_type::to_char_type(c);
    return traits_type::eq_int_type(c, traits_type::eof()) || xsputn(&byte, 1) == 1
               ? traits_type::not_eof(c)
               : traits_type::eof();
  }

  std::streamsize
  SealingBuffer::xsputn(const char *bytes, const std::streamsize n)
  {
    digest.update(bytes, static_cast<std::size_t>(n));
    out.write(bytes, n);
    return out ? n : 0;
  }

  void
  SealingBuffer::seal()
  {
    out << seal_of(digest.hex_digest());
  }

  void
  seal_file(const std::filesystem::path &file)
  {
    const std::string seal = seal_of(sha256(file));
    std::ofstream     out(file, std::ios::binary | std::ios::app);
    out << seal << std::flush;
    if (!out)
      throw std::runtime_error("Cannot write " + file.string() + "; is the disk full?");
  }

  std::string
  sealed(const std::string &bytes)
  {
    return bytes + seal_of(sha256_of_text(bytes));
  }

  std::optional<std::string>
  unsealed(std::string bytes)
  {
    if (bytes.size() <= seal_size)
      return std::nullopt;
    const std::string seal = bytes.substr(bytes.size() - seal_size);
    bytes.resize(bytes.size() - seal_size);
    return seal == seal_of(sha256_of_text(bytes)) ? std::optional(std::move(bytes)) : std::nullopt;
  }

  std::uintmax_t
  n_sealed_bytes(const std::filesystem::path &file)
  {
    std::error_code      error;
    const std::uintmax_t size = std::filesystem::is_regular_file(file, error)
                                    ? std::filesystem::file_size(file, error)
                                    : 0;
    if (error || size <= seal_size)
      return 0;
    std::ifstream in(file, std::ios::binary);
    in.seekg(static_cast<std::streamoff>(size - seal_size));
    std::string found(seal_size, '\0');
    in.read(found.data(), static_cast<std::streamsize>(seal_size));
    try
    {
      return in && found == seal_of(sha256_of_begin(file, size - seal_size)) ? size - seal_size : 0;
    }
    catch (const UserError &)
    {
      return 0;
    }
  }
} // namespace Exemplar
