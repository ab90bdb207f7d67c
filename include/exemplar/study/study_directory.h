// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_study_directory_h
#define exemplar_study_directory_h

#include <exemplar/base/directory_lock.h>

#include <filesystem>
#include <memory>
#include <set>
#include <string>

namespace Exemplar
{
  /// Where a study writes, and the names of what it writes.
  class StudyDirectory
  {
  public:
    explicit StudyDirectory(std::filesystem::path path);

    /// Make the directory and its parts, and keep other studies out of it as long as this object lives.
    /// Throws UserError, with nothing changed, if a study is running there already, if the directory is none,
    /// cannot be written or is not of a study, if something in it has the name of a study's
    /// file but is none, or if one of `input_files` would be replaced or removed.
    void
    take(const std::set<std::filesystem::path> &input_files);

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

    void
    refuse_directory_of_others() const;

    /// Throws UserError for what has the name of a study's file but is none.
    void
    refuse_what_is_foreign() const;

    void
    refuse_inputs(const std::set<std::filesystem::path> &input_files) const;

    std::filesystem::path                path;
    std::unique_ptr<const DirectoryLock> taken; ///< null: it is not
  };
} // namespace Exemplar

#endif
