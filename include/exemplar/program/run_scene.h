// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_run_scene_h
#define exemplar_run_scene_h

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Options of a run.
  struct RunOptions
  {
    std::filesystem::path    scene_file;
    std::vector<std::string> overrides; ///< "Section/Key=value"
    bool                     resume = false;
    bool                     quiet  = false;

    std::optional<unsigned int> resume_from; ///< the step after which to continue, with this scene
    bool                        verbose   = false; ///< a line an iteration instead of the bar
    unsigned int                n_threads = 1;
    bool allow_commands = false; ///< whether a .geo may run programs and write files
  };

  /// Solve a scene from its first (or, if resumed, its next) step to the last and write the
  /// results. Throws UserError before anything is written; SolverFailure and Interrupted after all
  /// results so far are on disk.
  void
  run_scene(const RunOptions &options);

  /// Read and check a scene and its files; compute and write nothing. Throws UserError.
  void
  validate_scene(const RunOptions &options);

  /// Print every parameter with its default, range, unit and meaning, as a .prm.
  void
  print_parameters();
} // namespace Exemplar

#endif
