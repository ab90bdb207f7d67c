// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/kept_file.h>
#include <exemplar/base/sealed_file.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace Exemplar
{
  namespace fs = std::filesystem;

  namespace
  {
    fs::path
    cache_directory()
    {
      const char *const cache = std::getenv("XDG_CACHE_HOME");
      if (cache != nullptr && cache[0] == '/') // the XDG standard ignores relative ones
        return fs::path(cache) / "exemplar";
      const char *const home = std::getenv("HOME");
      if (home != nullptr && home[0] != '\0')
        return fs::path(home) / ".cache" / "exemplar";
      throw UserError("There is no place to keep the mesh that is made: neither XDG_CACHE_HOME nor "
                      "HOME is set. Set one of them to a directory.");
    }

    [[noreturn]] void
    throw_no_cache(const fs::path &directory, const std::string &reason)
    {
      throw UserError(directory.string() + ": cannot be written (" + reason
                      + "), but is where meshes and poses that are made are kept. Set "
                        "XDG_CACHE_HOME to a directory that can be written.");
    }

    /// An empty directory that is removed in the end, with what is in it.
    class WorkingDirectory
    {
    public:
      explicit WorkingDirectory(const fs::path &parent)
      {
        std::string name = parent / "making-XXXXXX";
        if (::mkdtemp(name.data()) == nullptr)
          throw_no_cache(parent, std::strerror(errno));
        path = name;
      }

      WorkingDirectory(const WorkingDirectory &) = delete;
      WorkingDirectory &
      operator=(const WorkingDirectory &)
          = delete;

      ~WorkingDirectory()
      {
        std::error_code ignored;
        fs::remove_all(path, ignored);
      }

      fs::path path;
    };
  } // namespace

  fs::path
  kept_file(const std::string                           &name,
            const bool                                   anew,
            const std::function<void(const fs::path &)> &make)
  {
    const fs::path kept = cache_directory() / name;
    if (!anew && n_sealed_bytes(kept) > 0)
      return kept;
    std::error_code error;
    fs::create_directories(kept.parent_path(), error);
    if (error)
      throw_no_cache(kept.parent_path(), error.message());
    const WorkingDirectory directory(kept.parent_path());
    const fs::path         made = directory.path / ("made" + kept.extension().string());
    make(made);
    seal_file(made);
    fs::rename(made, kept);
    return kept;
  }
} // namespace Exemplar
