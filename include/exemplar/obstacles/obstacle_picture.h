// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_obstacle_picture_h
#define exemplar_obstacle_picture_h

#include <exemplar/algebra/vector.h>
#include <exemplar/obstacles/obstacles.h>
#include <exemplar/surface/shape/surface_mesh.h>

#include <optional>
#include <vector>

namespace Exemplar
{
  /// What pictures show of obstacles: a surface of polygons, counterclockwise seen from where the
  /// body may be, in a group for each obstacle. Balls and capsules are polyhedra inside of them.
  class ObstaclePicture
  {
  public:
    /// A half space is a square, eight `diameter` [m] wide. Vertices are in units of `unit` [m]. The
    /// obstacle of the number `without` is left out.
    ObstaclePicture(const Obstacles            &obstacles,
                    double                      diameter,
                    double                      unit    = 1.,
                    std::optional<unsigned int> without = {});

    /// The vertices at a time [s] of the obstacles of which this was made. A square's middle is
    /// below that of a body with nodes at `positions` [m], in steps of a diameter. All vertices of
    /// an obstacle that is not there are in its middle.
    std::vector<SurfaceMesh::Vertex>
    places(const Obstacles &obstacles, double time, const Vector &positions) const;

    /// At t = 0 beside a body about the origin.
    const SurfaceMesh &
    surface() const
    {
      return mesh;
    }

  private:
    /// An obstacle of this number, and its vertices in its axes [m], unless they change.
    struct Shown
    {
      unsigned int              number;
      std::vector<SpaceVector3> vertices;
    };

    void
    add(const Obstacle &obstacle, unsigned int number);

    double             diameter, unit;
    std::vector<Shown> all;
    SurfaceMesh        mesh;
  };
} // namespace Exemplar

#endif
