// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_obstacle_frames_h
#define exemplar_live_obstacle_frames_h

#include <exemplar/live/surface_frames.h>
#include <exemplar/obstacles/obstacle_picture.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar::Live
{
  /// Which way is up: against gravity, or along this axis if there is none.
  SpaceVector3
  up_of(const std::array<double, 3> &gravity, unsigned int axis_without);

  /// Where the ground of a scene's page is along the axis that points up [m]: at the first obstacle that is a half space
  /// across it and stays there; nothing without one.
  struct Floor
  {
    Floor(const Problem &problem, const SpaceVector3 &up);

    std::optional<double>       level;
    std::optional<unsigned int> obstacle; ///< its number
  };

  /// Messages about a scene's obstacles, but for the floor, which is drawn as the ground; none without.
  class ObstacleFrames
  {
  public:
    ObstacleFrames(const Problem &problem, const SpaceVector3 &up);

    /// An obstacle as viewers know it.
    struct Shown
    {
      std::string  name;
      unsigned int n_triangles; ///< of the surface, behind those of the obstacles before
      bool         is_movable;  ///< by hand: it has an end on all sides
      bool         has_left;    ///< taken away: nothing of it is seen
    };

    /// The obstacles of the surface, in its order.
    const std::vector<Shown> &
    shown() const
    {
      return list;
    }

    /// Whether the problem has had other obstacles when this was made.
    bool
    are_old(const Problem &problem) const
    {
      return present(problem) != names;
    }

    /// Their surface, and where they are.
    std::vector<Bytes>
    welcome(const Problem &problem) const;

    /// A frame, and where obstacles are then, once they have moved.
    Bytes
    beside(const Bytes &frame, const Problem &problem);

  private:
    /// Names of the obstacles that have not left.
    static std::vector<std::string>
    present(const Problem &problem);

    Bytes
    message(const Problem &problem, const std::vector<SurfaceMesh::Vertex> &places) const;

    std::vector<SurfaceMesh::Vertex>
    places(const Problem &problem) const;

    std::vector<std::string>         names; ///< of those that were present
    std::vector<Shown>               list;
    std::optional<ObstaclePicture>   picture;
    BodySurface                      surface;
    std::vector<SurfaceMesh::Vertex> at_start;
    bool                             have_moved = false;
  };
} // namespace Exemplar::Live

#endif
