// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_geo_meshing_h
#define exemplar_geo_meshing_h

#include <exemplar/base/process_copy.h>

#include <filesystem>
#include <string>

namespace Exemplar
{
  /// Restrictions of the process in which gmsh runs.
  enum class Confinement
  {
    none,
    kernel ///< all restrictions that the kernel supports
  };

  /// Mesh a script by gmsh, in a copy of this process that runs in `directory`. Returns what `gmsh
  /// -3 -format msh22` writes, with its numbers, its order and its 16 digits; empty if gmsh reports
  /// an error, see `messages`. With Confinement::kernel the copy may read only that directory and
  /// the system's files, see confine_this_process(); a comment (see comment_of()) lists the
  /// restrictions that were in force. Throws UserError where the kernel has none, SolverFailure as
  /// in_process_copy() does.
  std::string
  mesh_script(const std::filesystem::path &script,
              const std::filesystem::path &directory,
              Confinement                  confinement,
              const CopyTask              &task,
              CopyMessages                &messages);
} // namespace Exemplar

#endif
