// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/private_directory.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace Exemplar
{
  namespace fs = std::filesystem;

  namespace
  {
    const std::string prefix = "exemplar-private-";

    /// Whether a descriptor is that of the file at a path.
    bool
    is_at(const int descriptor, const fs::path &path)
    {
      struct stat open_one, there;
      return fstat(descriptor, &open_one) == 0 && lstat(path.c_str(), &there) == 0
             && open_one.st_dev == there.st_dev && open_one.st_ino == there.st_ino;
    }
  } // namespace

  int
  lock_in_use(const fs::path &path)
  {
    const int descriptor = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
    if (descriptor >= 0 && flock(descriptor, LOCK_EX | LOCK_NB) == 0 && is_at(descriptor, path))
      return descriptor;
    if (descriptor >= 0)
      close(descriptor);
    return -1;
  }

  void
  remove_leftovers(const fs::path &directory, const std::string &names)
  {
    std::error_code error;
    for (fs::directory_iterator entry(directory, error), end; !error && entry != end;
         entry.increment(error))
    {
      struct stat status;
      if (entry->path().filename().string().rfind(names, 0) != 0
          || lstat(entry->path().c_str(), &status) != 0 || status.st_uid != geteuid())
        continue;
      if (const int unused = lock_in_use(entry->path()); unused >= 0)
      {
        std::error_code ignored;
        fs::remove_all(entry->path(), ignored);
        close(unused);
      }
    }
  }

  PrivateDirectory::PrivateDirectory()
  {
    std::error_code none;
    const fs::path  found  = fs::temp_directory_path(none);
    const fs::path  parent = fs::absolute(none ? fs::path("/tmp") : found);
    remove_leftovers(parent, prefix);
    // retry if another process has tidied up in between; without a lock where locks are not
    // supported
    for (unsigned int attempt = 0; attempt < 3 && lock < 0; ++attempt)
    {
      fs::remove(directory, none);
      std::string name = parent / (prefix + "XXXXXX");
      if (mkdtemp(name.data()) == nullptr)
        throw UserError(parent.string() + ": no directory can be made there ("
                        + std::strerror(errno) + "). Set TMPDIR to one that can be written.");
      directory = name;
      lock      = lock_in_use(directory);
    }
  }

  PrivateDirectory::~PrivateDirectory()
  {
    std::error_code ignored;
    fs::remove_all(directory, ignored);
    if (lock >= 0)
      close(lock);
  }
} // namespace Exemplar
