// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_attachment_h
#define exemplar_surface_attachment_h

#include <exemplar/mesh/mesh_inputs.h>
#include <exemplar/surface/shape/closest_points.h>
#include <exemplar/surface/shape/vectors.h>

namespace Exemplar
{
  /// Attachment of the boundary nodes of a tetrahedral mesh to a surface: each to the nearest point
  /// of the surface at rest that faces as the body does, with an offset from it that turns with the
  /// triangle. Surface and boundary need not have the same resolution.
  class SurfaceAttachment
  {
  public:
    using Points   = std::vector<dealii::Point<3>>;
    using Vertices = std::vector<SurfaceMesh::Vertex>;

    /// Attaches the boundary nodes of a mesh, given by its nodes [m] and boundary faces, to the
    /// surface at rest [m].
    SurfaceAttachment(const Points                    &nodes,
                      const std::vector<BoundaryFace> &faces,
                      TriangleSurface                  surface);

    /// Attaches the given nodes, which may lie inside, to their nearest points; their get_areas()
    /// are 0.
    SurfaceAttachment(const Points             &nodes,
                      std::vector<unsigned int> which,
                      TriangleSurface           surface);

    /// Attaches the given nodes of a shell to the surface that it is: node i is vertex i; their get_areas() are 0.
    SurfaceAttachment(std::vector<unsigned int> which, TriangleSurface surface);

    /// The attached nodes: boundary nodes, ascending, or those that were given.
    const std::vector<unsigned int> &
    get_nodes() const
    {
      return nodes;
    }

    /// The part of the boundary's area that belongs to each of get_nodes() [m^2].
    const std::vector<double> &
    get_areas() const
    {
      return areas;
    }

    /// Distance of each of get_nodes() from the surface at rest [m].
    const std::vector<double> &
    get_distances() const
    {
      return distances;
    }

    /// The point of the surface at rest that each of get_nodes() is attached to.
    const std::vector<SurfacePoint> &
    get_points() const
    {
      return points;
    }

    /// The surface at rest [m].
    const TriangleSurface &
    get_surface() const
    {
      return rest;
    }

    /// Target places of get_nodes() in a pose, given by its vertices [m].
    Points
    targets(const Vertices &vertices) const;

  private:
    void
    hang(const Points &nodes, const std::vector<SpaceVector> &normals);

    dealii::Point<3>
    place(const SurfacePoint &point, const Vertices &vertices) const;

    std::vector<unsigned int>         nodes;
    std::vector<double>               areas, distances;
    TriangleSurface                   rest;
    std::vector<SurfacePoint>         points;
    std::vector<dealii::Tensor<1, 3>> offsets; ///< vectors from point to node, at rest [m]
  };

  class Mesh;

  /// Throws UserError if the mesh is not one of the inside of this surface: of another unit or
  /// other axes, or far from it.
  void
  check_attachment(const SurfaceAttachment &attachment,
                   const Mesh              &mesh,
                   const std::string       &surface_name);
} // namespace Exemplar

#endif
