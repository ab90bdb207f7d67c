// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_pose_command_h
#define exemplar_pose_command_h

#include <filesystem>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Options of `exemplar pose`.
  struct PoseOptions
  {
    std::filesystem::path    mesh, rest, output;
    std::vector<std::string> poses; ///< files, or patterns of files with * and ?
    double                   attach    = 30.;
    unsigned int             n_threads = 1;
    bool                     quiet     = false;
  };

  /// Carry each pose of the surface onto the mesh: write OUTPUT/NAME.msh for a pose NAME.obj, and
  /// OUTPUT/poses.csv. Throws UserError before anything is written, and SolverFailure, with the
  /// elements, after the other poses are written, if cells stay inverted.
  void
  carry_poses(const PoseOptions &options);
} // namespace Exemplar

#endif
