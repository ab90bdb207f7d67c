// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_pose_carrying_h
#define exemplar_pose_carrying_h

#include <exemplar/mesh/mesh.h>
#include <exemplar/surface/posing/pose_transfer.h>

namespace Exemplar
{
  /// A surface at rest, with its name in messages.
  struct RestSurface
  {
    explicit RestSurface(const std::filesystem::path &file);

    std::string name;
    SurfaceMesh surface;
  };

  /// Reads a pose of a surface. Throws UserError for one that is none, see surface_poses.h.
  SurfaceMesh
  read_pose_surface(const std::filesystem::path &file, const RestSurface &rest);

  /// Makes a PoseTransfer from poses of a surface to a mesh of its inside, which follows the
  /// surface's vertices. Throws UserError if the mesh is not one of the surface's inside.
  PoseTransfer
  make_pose_transfer(const Mesh        &mesh,
                     const RestSurface &rest,
                     double             attach,
                     unsigned int       n_threads);

  /// Whether the mesh is one of the inside of this surface.
  bool
  is_surface_of(const Mesh &mesh, const SurfaceMesh &surface);

  /// The numbers of the elements whose cells count as inverted at these places of the nodes, as a
  /// list; empty if there are none.
  std::string
  inverted_elements(const PoseTransfer                  &transfer,
                    const Mesh                          &mesh,
                    const std::vector<dealii::Point<3>> &x);
} // namespace Exemplar

#endif
