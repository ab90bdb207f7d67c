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

// A sealed file ends in the SHA-256 of all its bytes before, so that one which was damaged is told
// from a whole one. The seal has the form of a section of a gmsh .msh file, which may carry one.

namespace Exemplar
{
  /// Passes bytes on to a stream that is to become a sealed file.
  class SealingBuffer : public std::streambuf
  {
  public:
    /// Keeps a reference.
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

  /// Write the seal behind the bytes of a file. Throws std::runtime_error if that fails.
  void
  seal_file(const std::filesystem::path &file);

  /// Bytes and their seal, as a sealed file holds them.
  std::string
  sealed(const std::string &bytes);

  /// What stands in front of the seal; nothing if there is none, or not of these bytes.
  std::optional<std::string>
  unsealed(std::string bytes);

  /// Number of bytes in front of the seal; 0 if there is none, if it is not of these bytes, or if
  /// this is no file that can be read.
  std::uintmax_t
  n_sealed_bytes(const std::filesystem::path &file);
} // namespace Exemplar

#endif
