// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_run_files_h
#define exemplar_run_files_h

#include <filesystem>

namespace Exemplar
{
  /// The names of the files of a run in its directory.
  struct RunFiles
  {
    std::filesystem::path directory;

    /// The scene as given.
    std::filesystem::path
    original_prm() const
    {
      return directory / "original.prm";
    }

    std::filesystem::path
    parameters_prm() const
    {
      return directory / "parameters.prm";
    }

    std::filesystem::path
    statistics() const
    {
      return directory / "statistics.csv";
    }

    std::filesystem::path
    summary() const
    {
      return directory / "summary.json";
    }

    /// The messages of the run.
    std::filesystem::path
    log() const
    {
      return directory / "log.txt";
    }

    std::filesystem::path
    final_pose() const
    {
      return directory / "final.msh";
    }

    /// The rest mesh if Mesh/File is a surface; final.msh is a pose of it.
    std::filesystem::path
    rest_mesh() const
    {
      return directory / "rest.msh";
    }

    std::filesystem::path
    checkpoint() const
    {
      return directory / "checkpoint.bin";
    }

    /// The kept state of a step's frame.
    std::filesystem::path
    state(unsigned int step) const;
  };
} // namespace Exemplar

#endif
