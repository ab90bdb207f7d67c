// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_private_directory_h
#define exemplar_private_directory_h

#include <filesystem>

namespace Exemplar
{
  /// An empty directory that nobody else may look into. It is removed in the end, with what is in
  /// it; where its process was killed, the next one that needs such a directory does it.
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

  /// Takes the lock by which others see that a file or directory is in use, for as long as the
  /// descriptor is open, which is returned. Negative if there is no such file, or if it is locked.
  int
  lock_in_use(const std::filesystem::path &path);

  /// Removes what processes that were killed have left: files and directories of this user whose
  /// names begin with `prefix` and that nobody has locked by lock_in_use().
  void
  remove_leftovers(const std::filesystem::path &directory, const std::string &prefix);
} // namespace Exemplar

#endif
