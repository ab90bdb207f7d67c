// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/kept_bytes.h>
#include <exemplar/base/private_directory.h>
#include <exemplar/base/sealed_file.h>
#include <exemplar/base/text_file.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <system_error>

namespace Exemplar
{
  namespace fs = std::filesystem;

  namespace
  {
    const std::string unfinished = "making-";

    /// The absolute path that a variable gives; the XDG standard ignores relative ones.
    std::optional<fs::path>
    path_in(const char *variable)
    {
      const char *const value = std::getenv(variable);
      return value != nullptr && value[0] == '/' ? std::optional<fs::path>(value) : std::nullopt;
    }

    std::optional<fs::path>
    cache_directory()
    {
      if (const auto cache = path_in("XDG_CACHE_HOME"))
        return *cache / "exemplar";
      if (const auto home = path_in("HOME"))
        return *home / ".cache" / "exemplar";
      return std::nullopt;
    }

    std::string
    not_kept(const std::string &reason)
    {
      return "Meshes and poses that take long to make are not kept: " + reason
             + ". Set XDG_CACHE_HOME to a directory of your own.";
    }

    std::string
    last_reason()
    {
      return std::strerror(errno);
    }

    /// Makes the directory if necessary. Returns why it cannot be used, or nothing.
    std::string
    why_unusable(const fs::path &directory)
    {
      std::error_code error;
      fs::create_directories(directory.parent_path(), error);
      if (mkdir(directory.c_str(), 0700) != 0 && errno != EEXIST)
        return directory.string() + " cannot be made (" + last_reason() + ")";
      struct stat status;
      if (stat(directory.c_str(), &status) != 0 || !S_ISDIR(status.st_mode))
        return directory.string() + " is no directory";
      if (status.st_uid != geteuid() && status.st_uid != 0)
        return directory.string() + " belongs to somebody else";
      if ((status.st_mode & (S_IWGRP | S_IWOTH)) != 0)
        return directory.string() + " may be written by others (chmod go-w makes it yours)";
      return "";
    }

    [[noreturn]] void
    throw_last_error(const fs::path &path)
    {
      throw std::system_error(errno, std::generic_category(), path.string());
    }

    /// A new file, removed by the destructor unless renamed to its place. Throws std::system_error.
    class NewFile
    {
    public:
      explicit NewFile(const fs::path &directory)
      {
        // retry if another process has tidied up in between; without a lock where locks are not
        // supported
        for (unsigned int attempt = 0; attempt < 3 && lock < 0; ++attempt)
        {
          remove();
          name       = directory / (unfinished + "XXXXXX");
          descriptor = mkostemp(name.data(), O_CLOEXEC);
          if (descriptor < 0)
            throw_last_error(directory);
          lock = lock_in_use(name);
        }
      }

      NewFile(const NewFile &) = delete;
      NewFile &
      operator=(const NewFile &)
          = delete;

      ~NewFile()
      {
        remove();
        if (lock >= 0)
          close(lock);
      }

      void
      write(const std::string &bytes) const
      {
        for (std::size_t n = 0; n < bytes.size();)
        {
          const ssize_t written = ::write(descriptor, bytes.data() + n, bytes.size() - n);
          if (written < 0 && errno != EINTR)
            throw_last_error(name);
          n += written > 0 ? static_cast<std::size_t>(written) : 0;
        }
      }

      void
      move_to(const fs::path &place) const
      {
        if (std::rename(name.c_str(), place.c_str()) != 0)
          throw_last_error(place);
      }

    private:
      /// Remove the temporary file; harmless after renaming.
      void
      remove()
      {
        if (descriptor < 0)
          return;
        close(descriptor);
        unlink(name.c_str());
        descriptor = -1;
      }

      std::string name;
      int         descriptor = -1;
      int         lock       = -1;
    };

    /// Write bytes to their place in the cache. Returns why it failed, or nothing.
    std::string
    keep(const std::string &bytes, const fs::path &place)
    {
      try
      {
        const NewFile file(place.parent_path());
        file.write(sealed(bytes));
        file.move_to(place);
        return "";
      }
      catch (const std::system_error &error)
      {
        return error.what();
      }
    }

    std::optional<std::string>
    read_kept(const fs::path &place)
    {
      auto bytes = read_text_file(place);
      return bytes ? unsealed(std::move(*bytes)) : std::nullopt;
    }
  } // namespace

  KeptBytes
  kept_bytes(const std::string &name, const std::function<std::string()> &make)
  {
    const auto directory = cache_directory();
    if (!directory)
      return { make(), not_kept("neither XDG_CACHE_HOME nor HOME names a directory by a path from "
                                "the root") };
    if (const std::string why = why_unusable(*directory); !why.empty())
      return { make(), not_kept(why) };
    if (auto bytes = read_kept(*directory / name))
      return { std::move(*bytes), "" };
    remove_leftovers(*directory, unfinished);
    KeptBytes         made{ make(), "" };
    const std::string why = keep(made.bytes, *directory / name);
    if (!why.empty())
      made.warning = not_kept(why);
    return made;
  }
} // namespace Exemplar
