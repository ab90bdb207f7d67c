// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_private_directory_h
#define exemplar_private_directory_h

#include <filesystem>

namespace Exemplar
{
  /// A new empty directory without access for others. It is removed by the destructor, with its
  /// contents; after a crash, by the next process that makes such a directory.
  class PrivateDirectory
  {
  public:
    /// Makes one among the temporary files (TMPDIR, or /tmp). Throws UserError if that fails.
    PrivateDirectory();
    ~PrivateDirectory();

    PrivateDirectory(const PrivateDirectory &) = delete;
    PrivateDirectory &
    operator=(const PrivateDirectory &)
        = delete;

    const std::filesystem::path &
    path() const
    {
      return directory;
    }

  private:
    std::filesystem::path directory;
    int                   lock = -1;
  };

  /// Locks a file or directory as in use, for as long as the returned descriptor is open. Negative
  /// if there is no such file, or if it is locked.
  int
  lock_in_use(const std::filesystem::path &path);

  /// Removes leftovers of killed processes: files and directories of this user whose names begin
  /// with `prefix` and that are not locked by lock_in_use().
  void
  remove_leftovers(const std::filesystem::path &directory, const std::string &prefix);
} // namespace Exemplar

#endif
