// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/obstacles/box_tree.h>
#include <exemplar/obstacles/obstacle_picture.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    using Polygons = std::vector<std::vector<unsigned int>>;

    constexpr double part_of_square = 4.; ///< half the side of a half space's square, in diameters

    /// Two directions across a unit vector, counterclockwise seen from its end; along the axes, if that is.
    std::array<SpaceVector3, 2>
    directions_across(const SpaceVector3 &axis)
    {
      unsigned int least = 0;
      for (unsigned int c = 1; c < 3; ++c)
        if (std::abs(axis[c]) < std::abs(axis[least]))
          least = c;
      SpaceVector3 first = -axis[least] * axis;
      first[least] += 1.;
      first /= first.norm();
      return { { first, dealii::cross_product_3d(axis, first) } };
    }

    /// The corners of a box, bit c of the index says the side along axis c, and its faces, seen from outside or inside.
    std::vector<SpaceVector3>
    box_about(const SpaceVector3 &half_sizes, const bool from_outside, Polygons &faces)
    {
      std::vector<SpaceVector3> corners(8, half_sizes);
      for (unsigned int i = 0; i < 8; ++i)
        for (unsigned int c = 0; c < 3; ++c)
          corners[i][c] *= (i >> c & 1U) != 0 ? 1. : -1.;
      for (unsigned int c = 0; c < 3; ++c)
        for (const unsigned int side : { 0U, 1U << c })
        {
          const unsigned int a = 1U << (c + 1) % 3, b = 1U << (c + 2) % 3;
          faces.push_back({ side, side | a, side | a | b, side | b });
          if ((side == 0) == from_outside)
            std::reverse(faces.back().begin(), faces.back().end());
        }
      return corners;
    }

    /// A capsule between two points, or a ball about one that is both: rings from pole to pole.
    std::vector<SpaceVector3>
    capsule_between(const SpaceVector3 &begin,
                    const SpaceVector3 &end,
                    const double        radius,
                    Polygons           &faces)
    {
      constexpr unsigned int n_around = 64, n_rings = 32; // half of the rings about each end
      SpaceVector3           axis      = end - begin;
      const double           length    = axis.norm();
      axis                             = length > 0. ? axis / length : SpaceVector3({ 0., 0., 1. });
      const auto                across = directions_across(axis);
      std::vector<SpaceVector3> vertices = { begin - radius * axis };
      for (unsigned int ring = 0; ring < n_rings; ++ring)
      {
        const bool   at_end = ring >= n_rings / 2;
        const double height = (ring + (at_end ? 0. : 1.)) / n_rings
                              * dealii::numbers::PI; // the equator is there twice
        for (unsigned int i = 0; i < n_around; ++i)
        {
          const double angle = 2. * dealii::numbers::PI * i / n_around;
          vertices.push_back((at_end ? end : begin) - radius * std::cos(height) * axis
                             + radius * std::sin(height)
                                   * (std::cos(angle) * across[0] + std::sin(angle) * across[1]));
        }
      }
      vertices.push_back(end + radius * axis);
      const unsigned int last = vertices.size() - 1;
      for (unsigned int i = 0; i < n_around; ++i)
      {
        const unsigned int next = (i + 1) % n_around;
        faces.push_back({ 0, 1 + next, 1 + i });
        for (unsigned int ring = 0; ring + 1 < n_rings; ++ring)
        {
          const unsigned int low = 1 + ring * n_around, high = low + n_around;
          faces.push_back({ low + i, low + next, high + next, high + i });
        }
        faces.push_back({ last - n_around + i, last - n_around + next, last });
      }
      return vertices;
    }

    /// The square of a half space about the foot of a point, which goes in steps of a diameter.
    std::vector<SpaceVector3>
    square_below(const ObstacleShape::HalfSpace &of,
                 const SpaceVector3             &point,
                 const double                    diameter)
    {
      const auto                across = directions_across(of.normal);
      SpaceVector3              middle = of.offset * of.normal;
      std::vector<SpaceVector3> vertices;
      for (const SpaceVector3 &along : across)
        middle += diameter * std::round(point * along / diameter) * along;
      const double half = part_of_square * diameter;
      for (const auto &[a, b] :
           { std::pair(-half, -half), { half, -half }, { half, half }, { -half, half } })
        vertices.push_back(middle + a * across[0] + b * across[1]);
      return vertices;
    }
    bool
    is_square(const ObstacleShape &shape)
    {
      return shape.half_spaces.size() == 1 && shape.vertices.empty();
    }

    bool
    is_room(const ObstacleShape &shape)
    {
      return shape.bounds && shape.half_spaces.size() == 6 && shape.vertices.empty();
    }

    bool
    is_capsule(const ObstacleShape &shape)
    {
      const std::size_t n = shape.vertices.size();
      return (n == 1 || n == 2) && shape.edges.size() == n - 1 && shape.half_spaces.empty();
    }

    /// Of the box around nodes; the origin without any [m].
    SpaceVector3
    middle_of(const Vector &positions)
    {
      AxisBox box;
      for (unsigned int dof = 0; dof < positions.size(); dof += 3)
        box.add(SpaceVector3({ positions[dof], positions[dof + 1], positions[dof + 2] }));
      return positions.size() == 0 ? SpaceVector3() : 0.5 * (box.low + box.high);
    }
  } // namespace

  ObstaclePicture::ObstaclePicture(const Obstacles                  &obstacles,
                                   const double                      diameter,
                                   const double                      unit,
                                   const std::optional<unsigned int> without)
      : diameter(diameter), unit(unit)
  {
    for (unsigned int i = 0; i < obstacles.all.size(); ++i)
      if (i != without)
        add(obstacles.all[i], i);
    mesh.vertices = places(obstacles, 0., Vector());
  }

  void
  ObstaclePicture::add(const Obstacle &obstacle, const unsigned int number)
  {
    const ObstacleShape      &shape = obstacle.shape();
    std::vector<SpaceVector3> vertices;
    Polygons                  faces;
    if (is_square(shape))
    {
      vertices.resize(4);
      faces = { { 0, 1, 2, 3 } };
    }
    else if (shape.is_surface())
    {
      vertices = shape.vertices;
      for (const auto &triangle : shape.triangles)
        faces.emplace_back(triangle.begin(), triangle.end());
    }
    else if (shape.half_sizes)
      vertices = box_about(*shape.half_sizes, true, faces);
    else if (is_room(shape))
    {
      SpaceVector3 half_sizes;
      for (unsigned int c = 0; c < 3; ++c)
        half_sizes[c] = -shape.half_spaces[2 * c].offset;
      vertices = box_about(half_sizes, false, faces);
    }
    else
    {
      AssertThrow(is_capsule(shape),
                  dealii::ExcMessage("Obstacles/" + obstacle.name()
                                     + " has a shape without a picture. Draw it in "
                                       "ObstaclePicture::add()."));
      vertices
          = capsule_between(shape.vertices.front(), shape.vertices.back(), shape.radius, faces);
    }
    mesh.group_names.push_back(obstacle.name());
    const auto first = static_cast<unsigned int>(mesh.vertices.size());
    for (auto &face : faces)
    {
      for (unsigned int &vertex : face)
        vertex += first;
      mesh.faces.push_back(std::move(face));
      mesh.face_groups.push_back(mesh.group_names.size() - 1);
    }
    mesh.vertices.resize(first + vertices.size());
    all.push_back({ number, std::move(vertices) });
  }

  std::vector<SurfaceMesh::Vertex>
  ObstaclePicture::places(const Obstacles &obstacles,
                          const double     time,
                          const Vector    &positions) const
  {
    std::vector<SurfaceMesh::Vertex> result;
    const SpaceVector3               body = middle_of(positions);
    for (const auto &[number, own] : all)
    {
      const Obstacle           &obstacle = obstacles.all[number];
      const ObstacleShape      &shape    = obstacle.shape();
      const ObstaclePose        pose     = obstacle.pose(time);
      std::vector<SpaceVector3> moved;
      if (is_square(shape))
        moved = square_below(shape.half_spaces[0], pose.to_own(body), diameter);
      else if (shape.is_surface())
        moved = obstacle.vertices(time);
      for (const SpaceVector3 &x : moved.empty() ? own : moved)
      {
        const SpaceVector3 place = (obstacle.is_there(time) ? pose.to_space(x) : pose.place) / unit;
        result.push_back({ { place[0], place[1], place[2] } });
      }
    }
    return result;
  }
} // namespace Exemplar
