// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_pose_carrying_h
#define exemplar_pose_carrying_h

#include <exemplar/mesh/mesh.h>
#include <exemplar/surface/posing/fold_solver.h>
#include <exemplar/surface/skin/pose_quality.h>
#include <exemplar/surface/skin/surface_attachment.h>
#include <exemplar/surface/skin/surface_skin.h>

#include <memory>

namespace Exemplar
{
  /// Carries poses of a surface onto a tetrahedral mesh of its inside, without inverted cells.
  class PoseTransfer
  {
  public:
    using Points = FoldPotential::Points;

    /// Takes nodes [m] and positively oriented cells of the mesh, the attachment of its boundary to
    /// the surface at rest, and its stiffness `attach`, over that of the body. Results do not
    /// depend on the number of threads.
    PoseTransfer(const Points               &nodes,
                 const FoldPotential::Cells &cells,
                 SurfaceAttachment           of_boundary,
                 double                      attach,
                 unsigned int                n_threads = 1);

    /// Draws all vertices that faces of the surface use, as runs carry them (SurfaceSkin), to their
    /// places, and measures errors at them. Without this call, both concern the boundary nodes.
    void
    follow_skin(const SurfaceMesh &rest, const Mesh &mesh);

    /// Calls `tell` after each step on the way to a pose, with their number.
    void
    tell_steps(const std::function<void(unsigned int)> &tell);

    /// Places of the nodes [m] for a pose, given by its vertices [m].
    Points
    carry(const SurfaceAttachment::Vertices &vertices, PoseQuality &quality);

    /// det F of each cell at these places of the nodes.
    std::vector<double>
    determinants(const Points &x) const
    {
      return potential->determinants(x);
    }

  private:
    void
    attach_to(const Points &targets);
    void
    draw_skin_nearer(FoldSolver::Result &result, const Points &places);
    void
    measure(const Points &x, PoseQuality &quality) const;
    void
    measure_boundary(const Points &x, const Points &targets, PoseQuality &quality) const;
    void
    measure_surface(const Points                      &x,
                    const SurfaceAttachment::Vertices &vertices,
                    PoseQuality                       &quality) const;
    void
    measure_motion(const Points &unmoved, PoseQuality &quality) const;

    Points                                   nodes;
    SurfaceAttachment                        attachment;
    std::unique_ptr<FoldPotential>           potential; ///< on the heap, as the solver refers to it
    FoldSolver                               solver;
    std::vector<double>                      stiffness; ///< springs of boundary nodes [1/m^2]
    std::unique_ptr<SurfaceSkin>             skin;      ///< null: only boundary nodes are followed
    std::vector<double>                      skin_stiffness; ///< initial, of `measured` [1/m^2]
    std::vector<std::size_t>                 measured;       ///< vertices of the surface
    std::vector<std::array<unsigned int, 2>> edges;          ///< edges of faces
  };

  PoseTransfer::Points
  as_points(const SurfaceAttachment::Vertices &vertices);

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
