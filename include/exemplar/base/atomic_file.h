// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_atomic_file_h
#define exemplar_atomic_file_h

#include <exemplar/base/open_directory.h>

#include <filesystem>
#include <memory>
#include <ostream>

namespace Exemplar
{
  /// A file that appears whole or not at all: it is written as `path`.tmp and renamed by commit().
  /// Without commit() the destructor removes the temporary and what stood at `path` stays. Opening
  /// and commit() throw std::runtime_error with the path and the system's reason (disk full, ...).
  /// The directory of `path` is that at opening, wherever it is moved.
  class AtomicFile
  {
  public:
    explicit AtomicFile(const std::filesystem::path &path);

    /// The temporary name of the file of this path.
    static std::filesystem::path
    temporary_of(std::filesystem::path path);

    AtomicFile(const AtomicFile &) = delete;
    AtomicFile &
    operator=(const AtomicFile &)
        = delete;

    ~AtomicFile();

    /// Binary: bytes arrive as they are. A failed write sets badbit, and commit()
    /// then says why.
    std::ostream &
    stream();

    /// Sync everything to the disk, then rename. Call this or the next once.
    void
    commit();

    /// Rename, and let the system choose when the bytes go to the disk: the file
    /// outlives a crash of the program, but perhaps not one of the machine.
    void
    commit_without_sync();

  private:
    class Buffer;

    void
    finish(bool to_disk);

    std::filesystem::path   path;
    std::filesystem::path   temporary;
    OpenDirectory           directory; ///< directory of both files
    std::unique_ptr<Buffer> buffer;
    std::ostream            out;
    bool                    committed = false;
  };
} // namespace Exemplar

#endif
