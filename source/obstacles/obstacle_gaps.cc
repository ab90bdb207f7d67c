// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/obstacles/box_tree.h>
#include <exemplar/obstacles/obstacle_gaps.h>

#include <algorithm>
#include <limits>

namespace Exemplar
{
  namespace
  {
    using PartCorners
        = std::vector<SpaceVector3>; ///< one of a point, two of an edge, three of a triangle

    /// The parts of an obstacle in space at a time; the faces of a box are triangles.
    struct PlacedObstacle
    {
      PlacedObstacle(const Obstacle &obstacle, const double time, const double range)
          : shape(obstacle.shape()), pose(obstacle.pose(time))
      {
        for (const SpaceVector3 &vertex : obstacle.vertices(time))
          vertices.push_back(pose.to_space(vertex));
        for (const unsigned int point : shape.points)
          parts.push_back({ vertices[point] });
        for (const auto &[a, b] : shape.edges)
          parts.push_back({ vertices[a], vertices[b] });
        for (const auto &[a, b, c] : shape.triangles)
          parts.push_back({ vertices[a], vertices[b], vertices[c] });
        if (shape.half_sizes)
          add_faces();
        std::vector<AxisBox> boxes;
        for (const PartCorners &part : parts)
        {
          AxisBox box;
          for (const SpaceVector3 &corner : part)
            box.add(corner);
          boxes.push_back(box.widened(shape.radius + 0.5 * range));
        }
        tree = BoxTree(boxes);
      }

      /// Two triangles for each side of a box, whose corners have the side along axis c in bit c of their index.
      void
      add_faces()
      {
        for (unsigned int c = 0; c < 3; ++c)
          for (unsigned int side = 0; side < 2; ++side)
          {
            const unsigned int a = side << c, b = a | 1U << (c + 1) % 3, d = a | 1U << (c + 2) % 3,
                               opposite = b | d;
            parts.push_back({ vertices[a], vertices[b], vertices[d] });
            parts.push_back({ vertices[opposite], vertices[b], vertices[d] });
          }
      }

      const ObstacleShape     &shape;
      const ObstaclePose       pose;
      PartCorners              vertices;
      std::vector<PartCorners> parts;
      BoxTree                  tree;
    };

    /// The distance of two parts: of edges, and of points from parts of any kind; infinity for others, whose distance is that of such
    /// parts of theirs.
    double
    distance_of(const PartCorners &a, const PartCorners &b)
    {
      if (a.size() > b.size())
        return distance_of(b, a);
      if (a.size() == 1 && b.size() == 3)
        return nearest({ { b[0], b[1], b[2] } }, a[0]).way.norm();
      if (b.size() <= 2)
        return nearest(std::array<SpaceVector3, 2>{ { a[0], a.back() } },
                       std::array<SpaceVector3, 2>{ { b[0], b.back() } })
            .way.norm();
      return std::numeric_limits<double>::infinity();
    }

    bool
    pass_through_each_other(const PartCorners &a, const PartCorners &b)
    {
      return (a.size() == 2 && b.size() == 3
              && passes_through({ { a[0], a[1] } }, { { b[0], b[1], b[2] } }))
             || (a.size() == 3 && b.size() == 2 && pass_through_each_other(b, a));
    }

    /// The distance of an obstacle's vertices from the half spaces of another one, and of half spaces that face each other.
    double
    distance_from_half_spaces(const PlacedObstacle &of, const PlacedObstacle &from)
    {
      constexpr double rounding = 1e-9;
      double           least    = std::numeric_limits<double>::infinity();
      for (const ObstacleShape::HalfSpace &half_space : from.shape.half_spaces)
      {
        const SpaceVector3 normal = from.pose.rotation * half_space.normal;
        const double       offset = half_space.offset + normal * from.pose.place;
        for (const SpaceVector3 &vertex : of.vertices)
          least = std::min(least, normal * vertex - offset - of.shape.radius);
        for (const ObstacleShape::HalfSpace &other : of.shape.half_spaces)
          if (const SpaceVector3 towards = of.pose.rotation * other.normal;
              normal * towards < rounding - 1.)
            least = std::min(least, -(other.offset + towards * of.pose.place) - offset);
      }
      return least;
    }

    double
    distance_of(const PlacedObstacle &a, const PlacedObstacle &b)
    {
      double least = std::min(distance_from_half_spaces(a, b), distance_from_half_spaces(b, a));
      a.tree.visit_pairs(b.tree,
                         [&](const unsigned int i, const unsigned int j)
                         {
                           least = pass_through_each_other(a.parts[i], b.parts[j])
                                       ? 0.
                                       : std::min(least, distance_of(a.parts[i], b.parts[j])
                                                             - a.shape.radius - b.shape.radius);
                         });
      return least;
    }
    /// Whether the middles of two obstacles stay where they are as seen from each other, and neither changes its form.
    bool
    keep_their_distance(const Obstacle &a, const Obstacle &b, const std::vector<double> &times)
    {
      constexpr double rounding = 1e-9;
      const auto way = [&](const double time) { return a.pose(time).place - b.pose(time).place; };
      const SpaceVector3 first = way(times.front());
      return !a.deforms() && !b.deforms()
             && std::all_of(times.begin(), times.end(),
                            [&](const double time) {
                              return (way(time) - first).norm() <= rounding * (1. + first.norm());
                            });
    }
  } // namespace

  std::optional<ObstacleGap>
  narrowest_gap(const std::vector<Obstacle> &obstacles,
                const std::vector<double>   &times,
                const double                 least,
                const double                 greatest)
  {
    std::vector<PlacedObstacle> placed;
    for (const Obstacle &obstacle : obstacles)
      placed.emplace_back(obstacle, times.front(), greatest);
    std::optional<ObstacleGap> narrowest;
    for (unsigned int i = 0; i < placed.size(); ++i)
      for (unsigned int j = i + 1; j < placed.size(); ++j)
        if (keep_their_distance(obstacles[i], obstacles[j], times))
          if (const double size = distance_of(placed[i], placed[j]);
              size > least && size < (narrowest ? narrowest->size : greatest))
            narrowest = ObstacleGap{ i, j, size };
    return narrowest;
  }
} // namespace Exemplar
