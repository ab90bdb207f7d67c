// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_run_directory_h
#define exemplar_run_directory_h

#include <exemplar/run/frame_formats.h>

#include <filesystem>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Where a run writes, and the names of what it writes, those of frames excepted.
  class RunDirectory
  {
  public:
    /// Keeps a reference to `formats`, all that frames of an earlier run may have.
    explicit RunDirectory(std::filesystem::path           path,
                          const std::vector<FrameFormat> &formats = frame_formats());

    /// Throws UserError if a new run may not write here: the directory holds foreign
    /// files, is no directory or cannot be written, or one of the run's inputs is
    /// among the files that would be cleared.
    void
    check_for_new_run(const std::vector<std::filesystem::path> &input_files) const;

    /// Create the directory, or clear it of what an earlier run wrote.
    void
    clear() const;

    const std::filesystem::path &
    get_path() const
    {
      return path;
    }

    std::filesystem::path
    original_prm() const
    {
      return path / "original.prm";
    }

    std::filesystem::path
    parameters_prm() const
    {
      return path / "parameters.prm";
    }

    std::filesystem::path
    statistics() const
    {
      return path / "statistics.csv";
    }

    std::filesystem::path
    summary() const
    {
      return path / "summary.json";
    }

    std::filesystem::path
    final_pose() const
    {
      return path / "final.msh";
    }

    std::filesystem::path
    checkpoint() const
    {
      return path / "checkpoint.bin";
    }

    /// The first line of parameters.prm: by it a directory is known as ours.
    static const std::string mark;

  private:
    /// Whether a run writes a file of this name, or leaves one if it is killed.
    bool
    is_own_name(const std::string &name) const;

    std::vector<std::filesystem::path>
    own_files() const;

    bool
    is_ours() const;

    std::filesystem::path           path;
    const std::vector<FrameFormat> &formats;
  };
} // namespace Exemplar

#endif
