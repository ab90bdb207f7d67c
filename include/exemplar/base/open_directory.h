// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_open_directory_h
#define exemplar_open_directory_h

#include <filesystem>

namespace Exemplar
{
  /// An open directory, which stays the same if its path comes to lead elsewhere.
  class OpenDirectory
  {
  public:
    /// An empty path is the working directory. If it cannot be opened, `errno` says why.
    explicit OpenDirectory(const std::filesystem::path &path);
    ~OpenDirectory();

    OpenDirectory(const OpenDirectory &) = delete;
    OpenDirectory &
    operator=(const OpenDirectory &)
        = delete;

    /// The descriptor; negative if it could not be opened.
    int
    get_descriptor() const
    {
      return descriptor;
    }

    /// Whether the path still leads to this directory, rather than to another one after a removal.
    /// A directory that could not be opened counts as in place.
    bool
    is_in_place() const;

  private:
    const std::filesystem::path path;
    const int                   descriptor;
  };
} // namespace Exemplar

#endif
