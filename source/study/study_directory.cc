// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/errors.h>
#include <exemplar/run/output_directory.h>
#include <exemplar/study/study_directory.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

namespace Exemplar
{
  namespace fs = std::filesystem;

  namespace
  {
    /// The first line of study.prm: by it a directory is known as ours.
    const std::string mark = "# exemplar: the study of this directory";

    const std::string remedy = " Give another one by --output.";
  } // namespace

  FileLock::FileLock(const fs::path &file, const std::string &refusal)
      : descriptor(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666))
  {
    if (descriptor >= 0 && ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    {
      ::close(descriptor);
      throw UserError(refusal);
    }
  }

  FileLock::~FileLock()
  {
    if (descriptor >= 0)
      ::close(descriptor);
  }

  StudyDirectory::StudyDirectory(fs::path path) : path(std::move(path)) {}

  bool
  StudyDirectory::is_ours() const
  {
    return begins_with(study_prm(), mark);
  }

  void
  StudyDirectory::check(const fs::path &study_file) const
  {
    const std::string place = "Output directory " + path.string();
    require_writable(path, remedy);
    if (!fs::exists(path) || fs::is_empty(path))
      return;
    if (!is_ours())
      throw UserError(place + " is not empty and holds no study of exemplar." + remedy);
    if (fs::equivalent(study_prm(), study_file))
      throw UserError(place + " holds the study file itself." + remedy);
  }

  void
  StudyDirectory::make() const
  {
    make_directory(path, remedy);
    if (!is_ours())
      write_study(""); // first: by it the directory is known as ours
    fs::create_directories(runs());
  }

  FileLock
  StudyDirectory::lock() const
  {
    return { runs() / "lock",
             "Another study is running in the output directory " + path.string() + "." + remedy };
  }

  void
  StudyDirectory::write_study(const std::string &study_text) const
  {
    AtomicFile file(study_prm());
    file.stream() << mark << '\n' << study_text;
    file.commit();
  }

  void
  StudyDirectory::remove_results() const
  {
    for (const fs::path &file : { csv(), markdown(), svg(), gnuplot() })
      fs::remove(file);
  }
} // namespace Exemplar
