// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_study_directory_h
#define exemplar_study_directory_h

#include <filesystem>
#include <string>

namespace Exemplar
{
  /// While it lives, no other process has a lock on the same file. Ends with the process,
  /// however that ends.
  class FileLock
  {
  public:
    /// Throws UserError with `refusal` if another has it.
    FileLock(const std::filesystem::path &file, const std::string &refusal);
    ~FileLock();

    FileLock(const FileLock &) = delete;
    FileLock &
    operator=(const FileLock &)
        = delete;

  private:
    const int descriptor;
  };

  /// Where a study writes, and the names of what it writes.
  class StudyDirectory
  {
  public:
    explicit StudyDirectory(std::filesystem::path path);

    /// Throws UserError if a study may not write here: the directory holds foreign files,
    /// is none or cannot be written, or holds the study file itself.
    void
    check(const std::filesystem::path &study_file) const;

    /// Make the directory and its parts.
    void
    make() const;

    /// Throws UserError if another study is running here.
    FileLock
    lock() const;

    /// Write the study into the directory.
    void
    write_study(const std::string &study_text) const;

    /// Remove the tables and the figure, which belong to earlier rows.
    void
    remove_results() const;

    std::filesystem::path
    study_prm() const
    {
      return path / "study.prm";
    }

    std::filesystem::path
    csv() const
    {
      return path / "study.csv";
    }

    std::filesystem::path
    markdown() const
    {
      return path / "study.md";
    }

    std::filesystem::path
    svg() const
    {
      return path / "study.svg";
    }

    std::filesystem::path
    gnuplot() const
    {
      return path / "study.gnuplot";
    }

    std::filesystem::path
    runs() const
    {
      return path / "runs";
    }

    const std::filesystem::path &
    get_path() const
    {
      return path;
    }

  private:
    bool
    is_ours() const;

    std::filesystem::path path;
  };
} // namespace Exemplar

#endif
