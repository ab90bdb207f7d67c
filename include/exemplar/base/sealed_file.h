// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_sealed_file_h
#define exemplar_sealed_file_h

#include <exemplar/base/digest.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>
#include <streambuf>
#include <string>

// A sealed file ends in the SHA-256 of all bytes before, by which damage is detected. The seal has
// the form of a section of a gmsh .msh file, which may carry one.

namespace Exemplar
{
  /// A stream buffer that passes bytes on to a stream, to make a sealed file.
  class SealingBuffer : public std::streambuf
  {
  public:
    /// Keeps a reference to `out`.
    explicit SealingBuffer(std::ostream &out) : out(out) {}

    /// Write the seal. To be called once, after all bytes.
    void
    seal();

  protected:
    int_type
    overflow(int_type c) override;

    std::streamsize
    xsputn(const char *bytes, std::streamsize n) override;

  private:
    std::ostream &out;
    Sha256        digest;
  };

  /// Append the seal to a file. Throws std::runtime_error if that fails.
  void
  seal_file(const std::filesystem::path &file);

  /// Bytes and their seal, as a sealed file holds them.
  std::string
  sealed(const std::string &bytes);

  /// The bytes before the seal; no value if there is none, or one of other bytes.
  std::optional<std::string>
  unsealed(std::string bytes);

  /// Number of bytes before the seal; 0 if there is none or one of other bytes, or if the file
  /// cannot be read.
  std::uintmax_t
  n_sealed_bytes(const std::filesystem::path &file);
} // namespace Exemplar

#endif
