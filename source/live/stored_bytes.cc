// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/stored_bytes.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace Exemplar::Live
{
  StoredBytes::StoredBytes(const std::string &bytes) : file(std::tmpfile()), size(bytes.size())
  {
    if (!file || std::fwrite(bytes.data(), 1, size, file.get()) != size
        || std::fflush(file.get()) != 0)
      throw std::system_error(errno, std::generic_category(),
                              "A temporary file in " P_tmpdir
                              ", which keeps what Undo needs, cannot be written");
  }

  std::string
  StoredBytes::get() const
  {
    std::string bytes(size, '\0');
    std::rewind(file.get());
    if (std::fread(bytes.data(), 1, size, file.get()) != size)
      throw std::runtime_error("A temporary file in " P_tmpdir
                               ", which keeps what Undo needs, cannot be read.");
    return bytes;
  }
} // namespace Exemplar::Live
