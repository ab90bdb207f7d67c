// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_stored_bytes_h
#define exemplar_live_stored_bytes_h

#include <exemplar/live/c_file.h>

#include <string>

namespace Exemplar::Live
{
  /// Bytes that are seldom needed again, in an unnamed file on disk, which lives as long as this.
  class StoredBytes
  {
  public:
    /// Throws std::system_error if they cannot be written.
    explicit StoredBytes(const std::string &bytes);

    /// Throws std::runtime_error if they cannot be read.
    std::string
    get() const;

  private:
    CFile       file;
    std::size_t size;
  };
} // namespace Exemplar::Live

#endif
