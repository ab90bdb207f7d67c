// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_joining_h
#define exemplar_mesh_joining_h

#include <exemplar/mesh/mesh_parameters.h>
#include <exemplar/mesh/msh_file.h>

#include <optional>
#include <vector>

namespace Exemplar
{
  /// One mesh of the files of Mesh/Files, which share no node. Nodes and elements of the k-th file, k =
  /// 0, 1, ..., have the file's numbers plus k times the least power of ten above all of them, and so
  /// have its physical tags. Groups are called after file and name, or file and number, such as "skin
  /// left"; the only region of a file has the name of the file. Throws UserError for numbers that do not
  /// fit into those of a .msh.
  MshFile
  join_meshes(std::vector<MshFile> files, const std::vector<PlacedFile> &placed);

  /// Places of all nodes where one of the files of a joined mesh is in this pose of it, which has the
  /// numbers, scale and place of the file, and the others are at rest; no value unless the pose has as
  /// many nodes as a file. Throws UserError, with `prefix` in front, if it fits several.
  std::optional<std::vector<dealii::Point<3>>>
  pose_of_one_file(const MshFile &pose, const MshFile &joined, const std::string &prefix);
} // namespace Exemplar

#endif
