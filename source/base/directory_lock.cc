// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/directory_lock.h>
#include <exemplar/base/errors.h>

#include <sys/file.h>

#include <cerrno>

namespace Exemplar
{
  DirectoryLock::DirectoryLock(const std::filesystem::path &directory, const std::string &refusal)
      : locked(directory)
  {
    const int descriptor = locked.get_descriptor();
    if (descriptor >= 0 && ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      throw UserError(refusal);
  }
} // namespace Exemplar
