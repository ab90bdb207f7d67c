// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/rigid_parts.h>
#include <exemplar/mesh/rigid_motion.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace Exemplar::Live
{
  std::array<float, 4>
  quaternion_of(const Matrix3<double> &rotation, const std::array<float, 4> *const before)
  {
    const AxisAngle       turn = axis_and_angle(rotation);
    const double          sine = std::sin(0.5 * turn.angle);
    std::array<double, 4> q{ { sine * turn.axis[0], sine * turn.axis[1], sine * turn.axis[2],
                               std::cos(0.5 * turn.angle) } };
    double                product = 0.;
    for (unsigned int i = 0; before != nullptr && i < 4; ++i)
      product += q[i] * static_cast<double>((*before)[i]);
    std::array<float, 4> result;
    for (unsigned int i = 0; i < 4; ++i)
      result[i] = static_cast<float>(product < 0. ? -q[i] : q[i]);
    return result;
  }

  namespace
  {
    /// The least vertex that polygons connect each vertex with.
    std::vector<unsigned int>
    parts_of(const std::vector<std::vector<unsigned int>> &polygons, const std::size_t n)
    {
      std::vector<unsigned int> above(n);
      std::iota(above.begin(), above.end(), 0U);
      const auto top = [&](unsigned int v)
      {
        while (above[v] != v)
          v = above[v] = above[above[v]];
        return v;
      };
      for (const auto &polygon : polygons)
        for (const unsigned int v : polygon)
        {
          const auto [low, high] = std::minmax({ top(v), top(polygon[0]) });
          above[high]            = low;
        }
      for (unsigned int v = 0; v < n; ++v)
        above[v] = top(v);
      return above;
    }

    Places
    chosen(const Places &places, const std::vector<unsigned int> &vertices)
    {
      Places result;
      for (const unsigned int v : vertices)
        result.push_back(places[v]);
      return result;
    }

    bool
    has_extent(const Places &places)
    {
      return std::any_of(places.begin(), places.end(),
                         [&](const dealii::Point<3> &x) { return x != places.front(); });
    }

    /// Add the frame in which the vertices are at these places.
    void
    add_key(RigidPart &part, const Places &places)
    {
      const RigidMotion motion = best_rigid_motion(part.vertices, places);
      const auto *const before = part.keys.empty() ? nullptr : &part.keys.back().rotation;
      RigidPart::Key    key{ {}, {}, has_extent(places) ? 1.F : 0.F };
      const bool        stays       = key.size == 0.F; // nothing tells how it is turned
      key.rotation                  = stays && before != nullptr ? *before
                                      : stays ? std::array<float, 4>{ { 0.F, 0.F, 0.F, 1.F } }
                                              : quaternion_of(motion.rotation, before);
      const dealii::Point<3> origin = stays ? places.front() : motion({});
      for (unsigned int c = 0; c < 3; ++c)
        key.translation[c] = static_cast<float>(origin[c]);
      for (std::size_t v = 0; !stays && v < places.size(); ++v)
        part.error = std::max(part.error, motion(part.vertices[v]).distance(places[v]));
      part.keys.push_back(key);
    }
  } // namespace

  std::vector<RigidPart>
  rigid_parts(const std::vector<std::vector<unsigned int>> &polygons,
              const std::vector<Places>                    &frames)
  {
    if (polygons.empty() || frames.empty())
      return {};
    const auto first_of = parts_of(polygons, frames.front().size());
    std::map<unsigned int, std::vector<unsigned int>> vertices; // of each part
    std::vector<unsigned int>                         number(first_of.size());
    for (unsigned int v = 0; v < first_of.size(); ++v)
    {
      number[v] = vertices[first_of[v]].size();
      vertices[first_of[v]].push_back(v);
    }
    std::map<unsigned int, RigidPart> parts;
    for (const auto &polygon : polygons)
      for (std::size_t k = 2; k < polygon.size(); ++k)
        parts[first_of[polygon[0]]].triangles.push_back(
            { { number[polygon[0]], number[polygon[k - 1]], number[polygon[k]] } });
    std::vector<RigidPart> result;
    for (auto &[first, part] : parts)
    {
      std::vector<Places> own;
      for (const Places &frame : frames)
        own.push_back(chosen(frame, vertices[first]));
      const auto shown = std::find_if(own.begin(), own.end(), has_extent);
      part.vertices    = shown == own.end() ? own.front() : *shown;
      const dealii::Tensor<1, 3> middle(centroid(part.vertices));
      for (dealii::Point<3> &x : part.vertices)
        x -= middle;
      for (const Places &places : own)
        add_key(part, places);
      result.push_back(std::move(part));
    }
    return result;
  }
  std::vector<RigidPart>
  rigid_obstacles(const RunMotion &motion, const double most_off, std::vector<std::string> &notes)
  {
    std::vector<RigidPart> parts;
    if (motion.obstacle_frames.size() == motion.frames.size())
      parts = rigid_parts(motion.obstacles, motion.obstacle_frames);
    const auto deforms = [most_off](const RigidPart &part) { return part.error > most_off; };
    if (std::any_of(parts.begin(), parts.end(), deforms))
      notes.push_back(
          "Obstacles whose shape changes are left out of the file: its nodes move rigidly.");
    parts.erase(std::remove_if(parts.begin(), parts.end(), deforms), parts.end());
    return parts;
  }
} // namespace Exemplar::Live
