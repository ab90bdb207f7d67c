// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_quadratic_msh_h
#define exemplar_quadratic_msh_h

#include <exemplar/mesh/msh_file.h>

#include <array>
#include <string>
#include <vector>

// Files of 10-node tetrahedra. A node in the middle of an edge is a "middle" here.

namespace Exemplar
{
  bool
  has_quadratic_tetrahedra(const MshFile &msh);

  /// Replace 10-node tetrahedra, 6-node triangles and 3-node lines by linear ones on their corners,
  /// with the numbers of the file, and note it in MshFile::note. Throws UserError, calling the file
  /// `name`, for an edge that is not straight with its node in the middle, to 1e-6 of its length.
  void
  take_corners(MshFile &msh, const std::string &name);

  /// Places of the nodes of the linear `mesh`, and then of the middles of its edges in the order of
  /// edges_of(), in a file of 10-node tetrahedra: these must have the corners of the mesh's, in the
  /// same order. Throws UserError, beginning with `prefix`, for others.
  std::vector<dealii::Point<3>>
  quadratic_pose(const MshFile &pose, const MshFile &mesh, const std::string &prefix);

  /// Convert `mesh` to 10-node tetrahedra, with its nodes, and the middles of `edges`, at `places`.
  /// Middles get the numbers after the greatest of the mesh. Lines and triangles that are no edges
  /// and faces of the tetrahedra stay linear.
  MshFile
  with_middles(const MshFile                                  &mesh,
               const std::vector<std::array<unsigned int, 2>> &edges,
               const std::vector<dealii::Point<3>>            &places);
} // namespace Exemplar

#endif
