// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_shell_inputs_h
#define exemplar_shell_inputs_h

#include <exemplar/mesh/mesh_inputs.h>

namespace Exemplar
{
  /// The mesh of a shell, not scaled: the triangles of a surface, polygons being cut as triangulate() does, with its groups as
  /// regions, or those of a mesh file. Throws UserError for a file that cannot be read.
  MshFile
  load_shell(const MeshParameters &parameters);

  /// Places of the nodes in a pose of a shell, a surface or a mesh file with the same triangles, not scaled. Places of the tips of
  /// normals follow where a final.msh has them. Throws UserError naming the first difference.
  std::vector<dealii::Point<3>>
  read_shell_pose(const std::filesystem::path &file,
                  const MshFile               &mesh,
                  const std::string           &mesh_name);
} // namespace Exemplar

#endif
