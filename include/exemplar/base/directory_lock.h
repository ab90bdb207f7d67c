// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_directory_lock_h
#define exemplar_directory_lock_h

#include <exemplar/base/open_directory.h>

#include <filesystem>
#include <string>

namespace Exemplar
{
  /// An exclusive lock on a directory, against other processes and this one. It is a lock on the
  /// open directory: nothing is written, and it ends with the process, however that ends. File
  /// systems without such locks (NFS, for one) exclude nobody.
  class DirectoryLock
  {
  public:
    /// Throws UserError with `refusal` if the directory is locked.
    DirectoryLock(const std::filesystem::path &directory, const std::string &refusal);

    /// OpenDirectory::is_in_place() of the locked directory.
    bool
    is_in_place() const
    {
      return locked.is_in_place();
    }

  private:
    const OpenDirectory locked;
  };
} // namespace Exemplar

#endif
