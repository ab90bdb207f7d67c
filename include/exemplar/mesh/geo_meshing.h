// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_geo_meshing_h
#define exemplar_geo_meshing_h

#include <exemplar/base/process_copy.h>

#include <filesystem>
#include <string>

namespace Exemplar
{
  /// What the process in which gmsh runs is kept from.
  enum class Confinement
  {
    none,
    kernel ///< all that this kernel has
  };

  /// Let gmsh mesh a script, in a copy of this process that runs in a directory. Returns
  /// what `gmsh -3 -format msh22` writes, with its numbers, its order and its 16 digits; empty if
  /// gmsh reports an error, see `messages`. With Confinement::kernel the copy may read nothing but
  /// that directory and the system's files, see confine_this_process(); a comment (see comment_of())
  /// has the walls that stood. Throws UserError where the kernel has none, SolverFailure as
  /// in_process_copy() does.
  std::string
  mesh_script(const std::filesystem::path &script,
              const std::filesystem::path &directory,
              Confinement                  confinement,
              const CopyTask              &task,
              CopyMessages                &messages);
} // namespace Exemplar

#endif
