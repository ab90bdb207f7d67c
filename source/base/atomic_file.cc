// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <streambuf>
#include <system_error>
#include <vector>

namespace Exemplar
{
  namespace
  {
    [[noreturn]] void
    throw_io_error(const std::filesystem::path &path, const std::string &action, const int reason)
    {
      throw std::runtime_error("Cannot " + action + " " + path.string() + ": "
                               + std::generic_category().message(reason) + ".");
    }
  } // namespace

  /// A stream buffer on a file descriptor. std::ofstream gives neither the
  /// descriptor that fsync needs nor the reason of an early failed write.
  class AtomicFile::Buffer : public std::streambuf
  {
  public:
    Buffer(const OpenDirectory &directory, const std::filesystem::path &name) : bytes(1 << 16)
    {
      if (directory.get_descriptor() >= 0) // otherwise errno is that of opening the directory
        descriptor = ::openat(directory.get_descriptor(), name.c_str(),
                              O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
      if (descriptor < 0)
        reason = errno;
      setp(bytes.data(), bytes.data() + bytes.size());
    }

    ~Buffer() override
    {
      if (descriptor >= 0)
        ::close(descriptor);
    }

    /// The first failure's errno, 0 if there was none.
    int
    get_reason() const
    {
      return reason;
    }

    void
    close(const bool to_disk)
    {
      if (write_pending() && to_disk && ::fsync(descriptor) != 0)
        reason = errno;
      if (::close(descriptor) != 0 && reason == 0)
        reason = errno;
      descriptor = -1;
    }

  protected:
    int_type
    overflow(const int_type c) override
    {
      if (!write_pending())
        return traits_type::eof();
      if (!traits_type::eq_int_type(c, traits_type::eof()))
        sputc(traits_type::to_char_type(c));
      return traits_type::not_eof(c);
    }

    int
    sync() override
    {
      return write_pending() ? 0 : -1;
    }

  private:
    bool
    write_pending()
    {
      for (const char *p = pbase(); p != pptr() && reason == 0;)
      {
        const ssize_t n = ::write(descriptor, p, static_cast<std::size_t>(pptr() - p));
        if (n >= 0)
          p += n;
        else if (errno != EINTR)
          reason = errno;
      }
      setp(bytes.data(), bytes.data() + bytes.size());
      return reason == 0;
    }

    int               descriptor = -1;
    int               reason     = 0;
    std::vector<char> bytes;
  };

  AtomicFile::AtomicFile(const std::filesystem::path &target)
      : path(target), temporary(temporary_of(target)), directory(target.parent_path()),
        buffer(std::make_unique<Buffer>(directory, temporary.filename())), out(buffer.get())
  {
    if (buffer->get_reason() != 0)
      throw_io_error(temporary, "create", buffer->get_reason());
  }

  std::filesystem::path
  AtomicFile::temporary_of(std::filesystem::path path)
  {
    return path += ".tmp";
  }

  AtomicFile::~AtomicFile()
  {
    if (!committed)
      ::unlinkat(directory.get_descriptor(), temporary.filename().c_str(), 0);
  }

  std::ostream &
  AtomicFile::stream()
  {
    return out;
  }

  void
  AtomicFile::commit()
  {
    finish(true);
  }

  void
  AtomicFile::commit_without_sync()
  {
    finish(false);
  }

  void
  AtomicFile::finish(const bool to_disk)
  {
    buffer->close(to_disk);
    if (buffer->get_reason() != 0)
      throw_io_error(temporary, "write", buffer->get_reason());
    if (!out)
      throw std::runtime_error("Cannot write " + temporary.string() + ": the stream has failed.");
    if (::renameat(directory.get_descriptor(), temporary.filename().c_str(),
                   directory.get_descriptor(), path.filename().c_str())
        != 0)
      throw_io_error(path, "replace", errno);
    committed = true;
  }
} // namespace Exemplar
