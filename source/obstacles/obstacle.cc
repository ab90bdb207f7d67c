// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/time_samples.h>
#include <exemplar/obstacles/box_tree.h>
#include <exemplar/obstacles/obstacle.h>
#include <exemplar/surface/shape/triangle_surface.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  dealii::Tensor<2, 3>
  rotation_by(const SpaceVector3 &vector)
  {
    const double         angle = vector.norm();
    dealii::Tensor<2, 3> result;
    const double         cosine    = std::cos(angle);
    const double         sine_part = angle > 0. ? std::sin(angle) / angle : 1.;
    const double square_part = angle > 0. ? 2. * std::pow(std::sin(0.5 * angle) / angle, 2) : 0.5;
    for (unsigned int i = 0; i < 3; ++i)
    {
      result[i][i] += cosine;
      for (unsigned int j = 0; j < 3; ++j)
        result[i][j] += square_part * vector[i] * vector[j];
      const unsigned int j = (i + 1) % 3, k = (i + 2) % 3;
      result[j][i] += sine_part * vector[k];
      result[i][j] -= sine_part * vector[k];
    }
    return result;
  }

  namespace
  {
    ObstacleShape
    make_shape(const ObstacleParameters &parameters, const ObstacleSurface *surface)
    {
      if (parameters.surface_file().empty())
        return parse_shape(parameters.shape, "Obstacles/" + parameters.name + "/Shape");
      return shape_of(TriangleSurface{ surface->vertices, surface->triangles, {} },
                      !surface->times.empty());
    }

    /// Throws UserError for a surface without extent.
    void
    refuse_point(const ObstacleShape &shape, const std::string &key)
    {
      const bool is_point = std::all_of(shape.vertices.begin(), shape.vertices.end(),
                                        [](const SpaceVector3 &x) { return x.norm() == 0.; });
      if (is_point)
        throw UserError(key
                        + ": all vertices of the surface are at one point. Look at the file and "
                          "its unit.");
    }

    /// Throws UserError for triangles that another edge of the surface passes through.
    void
    refuse_crossings(const ObstacleShape &shape, const std::string &key)
    {
      const auto          &x = shape.vertices;
      std::vector<AxisBox> boxes;
      for (const auto &triangle : shape.triangles)
      {
        boxes.emplace_back();
        for (const unsigned int v : triangle)
          boxes.back().add(x[v]);
      }
      const BoxTree tree(boxes);
      for (const auto &[i, j] : shape.edges)
      {
        AxisBox box;
        box.add(x[i]);
        box.add(x[j]);
        tree.visit(
            box,
            [&, i = i, j = j](const unsigned int t)
            {
              const auto &corner  = shape.triangles[t];
              const auto  touches = [&](const unsigned int v)
              { return std::count(corner.begin(), corner.end(), v) > 0; };
              if (touches(i) || touches(j)
                  || !passes_through({ { x[i], x[j] } },
                                     { { x[corner[0]], x[corner[1]], x[corner[2]] } }))
                return;
              const SpaceVector3 place = x[i] + shape.middle;
              throw UserError(fmt::format(
                  "{}: the surface intersects itself near ({:.4g}, {:.4g}, {:.4g}) m. Repair "
                  "it, as by exemplar mesh --repair, or give the parts as two obstacles.",
                  key, place[0], place[1], place[2]));
            });
      }
    }
  } // namespace

  Obstacle::Obstacle(const ObstacleParameters &parameters, const ObstacleSurface *surface)
      : called(parameters.name), coefficient(parameters.friction), when(parameters.time()),
        own_shape(make_shape(parameters, surface)),
        motion("Obstacles/" + parameters.name + "/Motion", parameters.motion, "t", 3),
        turn("Obstacles/" + parameters.name + "/Turn", parameters.turn, "t", 3)
  {
    if (surface == nullptr)
      return;
    track.track = surface->track;
    if (!own_shape.is_surface())
      return;
    refuse_point(own_shape, "Obstacles/" + called + "/Shape");
    refuse_crossings(own_shape, "Obstacles/" + called + "/Shape");
    if (surface->times.empty())
      return;
    track.times = surface->times;
    // the samples of the vertices that the shape has, in its order
    std::vector<int>          seen(surface->vertices.size(), 0);
    std::vector<unsigned int> used;
    for (const auto &triangle : surface->triangles)
      for (const unsigned int v : triangle)
        if (std::exchange(seen[v], 1) == 0)
          used.push_back(v);
    for (const auto &sample : surface->samples)
    {
      track.samples.emplace_back();
      for (const unsigned int v : used)
        track.samples.back().push_back(sample[v]);
    }
  }

  ObstaclePose
  Obstacle::pose(const double time) const
  {
    const SpaceVector3 moved = shift + carried.at(time);
    if (track.track.times.empty())
      return checked({ rotation_by(checked_turn(turn.vector({}, time), time)),
                       own_shape.middle + moved + motion.vector({}, time) },
                     time);
    const RigidTrack::Frame    frame = track.track.at(time);
    const SpaceVector3         displacement({ frame[0], frame[1], frame[2] });
    const dealii::Tensor<2, 3> rotation
        = rotation_by(checked_turn(SpaceVector3({ frame[3], frame[4], frame[5] }), time));
    const SpaceVector3 &middle = own_shape.middle;
    return checked(
        { rotation, moved + displacement + (track.track.is_of_space ? rotation * middle : middle) },
        time);
  }

  const SpaceVector3 &
  Obstacle::checked_turn(const SpaceVector3 &rotation_vector, const double time) const
  {
    constexpr double greatest = 1e9; // [rad]; doubles hold no more than 7 digits of such an angle
    if (const double angle = rotation_vector.norm(); !(angle <= greatest))
      throw SolverFailure(fmt::format(
          "Obstacles/{} is turned by {:.3g} rad at t = {:.6g} s. Angles up to 1e9 rad are allowed: "
          "look at its Turn or track, which are in radians.",
          called, angle, time));
    return rotation_vector;
  }

  ObstaclePose
  Obstacle::checked(const ObstaclePose &pose, const double time) const
  {
    constexpr double greatest = 1e50; // [m], as of nodes
    if (const double distance = pose.place.norm(); !(distance <= greatest))
      throw SolverFailure(fmt::format(
          "Obstacles/{} is {:.3g} m from the origin at t = {:.6g} s, which is too far to compute "
          "with. Look at its Motion or track.",
          called, distance, time));
    return pose;
  }

  SpaceVector3
  Obstacle::Carriage::at(const double time) const
  {
    // times of steps are rounded, and what was carried is exactly there
    const double rounded = 1e-9 * (end - begin);
    if (time >= end - rounded)
      return to;
    return time <= begin + rounded ? from : from + (time - begin) / (end - begin) * (to - from);
  }

  void
  Obstacle::carry(const SpaceVector3 &to, const double begin, const double end)
  {
    carried = { begin, end, carried.at(begin), to };
  }

  std::vector<SpaceVector3>
  Obstacle::vertices(const double time) const
  {
    if (!deforms())
      return own_shape.vertices;
    const auto [before, next, share] = samples_around(track.times, time);
    std::vector<SpaceVector3> result;
    for (std::size_t v = 0; v < track.samples[before].size(); ++v)
    {
      SpaceVector3 x;
      for (unsigned int c = 0; c < 3; ++c)
        x[c] = (1. - share) * track.samples[before][v][c] + share * track.samples[next][v][c]
               - own_shape.middle[c];
      result.push_back(x);
    }
    return result;
  }

  bool
  Obstacle::moves_between(const double time, const double other_time) const
  {
    if (time == other_time)
      return false;
    const ObstaclePose a = pose(time), b = pose(other_time);
    return a.place != b.place || a.rotation != b.rotation
           || (deforms() && vertices(time) != vertices(other_time));
  }

  void
  Obstacle::set_back(const double by, const SpaceVector3 &direction)
  {
    ++n_set_back;
    if (own_shape.is_surface())
      shift += by * direction;
    else
      own_shape.set_back(by);
  }

  std::size_t
  Obstacle::memory_consumption() const
  {
    std::size_t bytes = sizeof(*this) + own_shape.vertices.size() * sizeof(SpaceVector3)
                        + own_shape.edges.size() * sizeof(own_shape.edges[0])
                        + own_shape.triangles.size() * sizeof(own_shape.triangles[0]);
    for (const auto &sample : track.samples)
      bytes += sample.size() * sizeof(sample[0]);
    return bytes;
  }
} // namespace Exemplar
