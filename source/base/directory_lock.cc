// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/directory_lock.h>
#include <exemplar/base/errors.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

namespace Exemplar
{
  DirectoryLock::DirectoryLock(const std::filesystem::path &directory, const std::string &refusal)
      : path(directory), descriptor(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC))
  {
    if (descriptor >= 0 && ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    {
      ::close(descriptor);
      throw UserError(refusal);
    }
  }

  DirectoryLock::~DirectoryLock()
  {
    if (descriptor >= 0)
      ::close(descriptor);
  }

  bool
  DirectoryLock::is_in_place() const
  {
    struct stat locked, there;
    return descriptor < 0
           || (::fstat(descriptor, &locked) == 0 && ::stat(path.c_str(), &there) == 0
               && locked.st_dev == there.st_dev && locked.st_ino == there.st_ino);
  }
} // namespace Exemplar
