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
  /// The output directory of a study, and the names of its files.
  class StudyDirectory
  {
  public:
    explicit StudyDirectory(std::filesystem::path path);

    /// Make the directory and its subdirectories, and lock it for the lifetime of this object.
    /// Throws UserError, with nothing changed, if a study is running there already, if it is no
    /// directory, is write-protected or not of a study, if some file has the name of a study's file
    /// but is none, or if one of `input_files` would be replaced or removed.
    void
    take(const std::set<std::filesystem::path> &input_files);

    /// Write study.prm.
    void
    write_study(const std::string &study_text) const;

    /// Remove the tables and the figure, which are out of date.
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

    /// Throws UserError for a file that has the name of a study's file but is none.
    void
    refuse_what_is_foreign() const;

    void
    refuse_inputs(const std::set<std::filesystem::path> &input_files) const;

    std::filesystem::path                path;
    std::unique_ptr<const DirectoryLock> taken; ///< lock of this process; null: none
  };
} // namespace Exemplar

#endif
