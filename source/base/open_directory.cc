// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/open_directory.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

namespace Exemplar
{
  namespace
  {
    int
    open_directory(const std::filesystem::path &path)
    {
      const int readable = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
      // a directory in which files may be made, but not listed
      return readable < 0 && errno == EACCES
                 ? ::open(path.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC)
                 : readable;
    }
  } // namespace

  OpenDirectory::OpenDirectory(const std::filesystem::path &path)
      : path(path.empty() ? "." : path), descriptor(open_directory(this->path))
  {
  }

  OpenDirectory::~OpenDirectory()
  {
    if (descriptor >= 0)
      ::close(descriptor);
  }

  bool
  OpenDirectory::is_in_place() const
  {
    struct stat opened, there;
    return descriptor < 0
           || (::fstat(descriptor, &opened) == 0 && ::stat(path.c_str(), &there) == 0
               && opened.st_dev == there.st_dev && opened.st_ino == there.st_ino);
  }
} // namespace Exemplar
