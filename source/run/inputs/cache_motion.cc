// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/time_samples.h>
#include <exemplar/mesh/rigid_motion.h>
#include <exemplar/run/inputs/cache_motion.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

namespace Exemplar
{
  namespace
  {
    using Displacements = std::vector<dealii::Tensor<1, 3>>;

    /// Displacements of points at given times, interpolated linearly.
    struct Track
    {
      std::vector<double>        times; ///< [s]
      std::vector<Displacements> samples;

      Displacements
      at(const double time) const
      {
        const auto [before, next, share] = samples_around(times, time);
        Displacements result             = samples[before];
        for (std::size_t i = 0; i < result.size() && share > 0.; ++i)
          result[i] += share * (samples[next][i] - result[i]);
        return result;
      }
    };

    /// Size of a set of points: the root mean square of the distances from their mean.
    double
    spread(const PointCache::Vertices &points)
    {
      SurfaceMesh::Vertex sum{};
      double              squares = 0.;
      for (const auto &point : points)
        for (unsigned int c = 0; c < 3; ++c)
        {
          sum[c] += point[c];
          squares += point[c] * point[c];
        }
      const auto n = static_cast<double>(points.size());
      return std::sqrt(
          std::max(0., squares - (sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]) / n) / n);
    }

    /// A ratio of sizes that tells another unit: no rig scales a surface that much.
    constexpr double other_unit = 20.;

    void
    check_unit(const SurfaceMesh          &rest,
               const PointCache::Vertices &vertices,
               const std::string          &sample,
               const std::string          &key)
    {
      const double ratio = spread(vertices) / spread(rest.vertices);
      if (!(ratio < other_unit && ratio > 1. / other_unit))
        throw UserError(key + ": in " + sample + " the surface is " + short_text(ratio)
                        + " times as large as at rest. Export both in the same unit of length.");
    }

    using Points = std::vector<dealii::Point<3>>;

    Points
    points_of(const PointCache::Vertices &vertices)
    {
      Points points;
      for (const auto &x : vertices)
        points.emplace_back(x[0], x[1], x[2]);
      return points;
    }

    constexpr double in_degrees = 180. / 3.14159265358979324;

    /// Rotation between two samples that rigs do not reach at usual sampling rates.
    constexpr double great_turn = 60. / in_degrees;

    std::string
    turn_text(const AxisAngle &turn)
    {
      constexpr double rounding = 1e-3;
      std::string      axis;
      for (unsigned int d = 0; d < 3; ++d)
        axis += (d == 0 ? "" : ", ")
                + short_text(std::abs(turn.axis[d]) < rounding ? 0. : turn.axis[d]);
      return fmt::format("{} degrees about ({})", std::lround(turn.angle * in_degrees), axis);
    }

    /// Text on a great rotation of a handle's nodes within one sample of the cache; empty if there
    /// is none. Samples longer than a step of the scene are skipped: the handle itself warns of
    /// those.
    std::string
    describe_great_turn(const Points &rest, const Track &track, const double scene_step)
    {
      for (std::size_t k = 1; k < track.samples.size(); ++k)
      {
        if (track.times[k] - track.times[k - 1] > scene_step)
          continue;
        Points before = rest, after = rest;
        for (std::size_t i = 0; i < rest.size(); ++i)
        {
          before[i] += track.samples[k - 1][i];
          after[i] += track.samples[k][i];
        }
        if (const AxisAngle turn = rigid_turn(before, after); turn.angle > great_turn)
          return fmt::format("/Follow cache turns the held nodes by {} from sample {} to the next. "
                             "Give the cache more samples, or, if its axes are others from there "
                             "on, export all with those of Mesh/Surface.",
                             turn_text(turn), k);
      }
      return "";
    }

    std::string
    remedy_for_jump(const SurfaceMesh          &rest,
                    const PointCache::Vertices &first,
                    const std::string          &key)
    {
      const AxisAngle turn = rigid_turn(points_of(rest.vertices), points_of(first));
      if (turn.angle > great_turn)
        return " In its first sample the surface is the one at rest, turned by " + turn_text(turn)
               + ": export both with the same axes.";
      return " Let the cache begin with the surface at rest, or set " + key
             + "/Cache start or Initial/Pose.";
    }

    /// Warn of a cache that is longer than the scene, whose t ends at 1 unless it is dynamic.
    void
    warn_of_unreached(const SurfaceSources      &from,
                      const std::vector<double> &times,
                      const HandleParameters    &handle)
    {
      const std::string key = "Handles/" + handle.name;
      if (from.scene.scene == SceneKind::dynamic)
      {
        if (times.front() >= from.scene.time.end && times.size() > 1)
          from.warnings.push_back(
              fmt::format("{}/Follow cache begins at t = {} s, and the scene ends at {} s: nothing "
                          "of it is followed. Change {}/Cache start or Time/End.",
                          key, short_text(times.front()), short_text(from.scene.time.end), key));
        return;
      }
      if (times.back() <= 1. + 1e-6)
        return;
      const auto n_reached  = std::upper_bound(times.begin(), times.end(), 1. + 1e-6);
      const bool has_frames = std::filesystem::path(handle.follow_cache).extension() != ".mdd";
      from.warnings.push_back(
          fmt::format("{}/Follow cache goes to t = {} s, but t of a static scene ends at 1, after "
                      "{} of {} samples. Set Scene = dynamic and Time/End = {}{}",
                      key, short_text(times.back()), n_reached - times.begin(), times.size(),
                      shortest_text(times.back()),
                      has_frames ? ", or a greater " + key + "/Frames per second." : "."));
    }

    const PointCache &
    find_cache(const SurfaceSources &from, const HandleParameters &handle)
    {
      const auto cache = from.inputs.caches.find(handle.name);
      if (cache == from.inputs.caches.end())
        throw UserError("Handles/" + handle.name
                        + ": there is no cache of this handle among the inputs. Hand it in, or "
                          "read it from its file.");
      return *cache->second;
    }

    std::vector<double>
    times_of(const PointCache &cache, const HandleParameters &handle)
    {
      std::vector<double> times = cache.get_times();
      if (handle.cache_start == "file")
        return times;
      const double shift = parse_number(handle.cache_start) - times.front();
      for (double &time : times)
        time += shift;
      return times;
    }

    /// The displacements of the nodes from rest in sample k.
    Displacements
    displacements_in(const SurfaceSources    &from,
                     const PointCache        &cache,
                     const std::size_t        k,
                     const Points            &rest,
                     const SurfaceAttachment &attached,
                     const std::string       &key)
    {
      auto vertices = cache.sample(k);
      check_unit(*from.inputs.surface, vertices, cache.name_of(k), key + "/Follow cache");
      for (auto &vertex : vertices)
        for (double &x : vertex)
          x *= from.scene.mesh.scale;
      const auto    targets = attached.targets(vertices);
      Displacements result;
      for (std::size_t i = 0; i < rest.size(); ++i)
        result.push_back(targets[i] - rest[i]);
      const double farthest = 1e3 * from.mesh.diameter();
      for (const auto &displacement : result)
        if (!(displacement.norm() < farthest))
          throw UserError(fmt::format(
              "{}/Follow cache: in sample {} the surface is farther from its rest than 1000 times "
              "the body's size. Export the cache in the unit of the surface at rest.",
              key, k + 1));
      return result;
    }

    /// Warn of a track that does not start at the body's initial positions, and of great rotations.
    void
    warn_of_jumps(const SurfaceSources   &from,
                  const HandleParameters &handle,
                  const PointCache       &cache,
                  const Points           &rest,
                  const Track            &track)
    {
      const std::string key  = "Handles/" + handle.name;
      double            jump = 0.;
      for (const auto &displacement : track.at(0.))
        jump = std::max(jump, displacement.norm());
      if (jump > 1e-3 * from.mesh.diameter() && from.scene.initial.pose.empty()
          && from.scene.initial.pose_function.empty())
        from.warnings.push_back(
            key + "/Follow cache: at t = 0 the held nodes are up to " + short_text(jump)
            + " m from their rest, where the body starts, so they jump in the first step."
            + remedy_for_jump(*from.inputs.surface, cache.sample(0), key));
      const double step = from.scene.scene == SceneKind::dynamic ? from.scene.time.step
                                                                 : 1. / from.scene.time.increments;
      if (const std::string turn = describe_great_turn(rest, track, step); !turn.empty())
        from.warnings.push_back(key + turn);
    }
  } // namespace

  Motion
  motion_by_cache(const SurfaceSources            &from,
                  const HandleParameters          &handle,
                  const std::vector<unsigned int> &nodes)
  {
    const PointCache &cache    = find_cache(from, handle);
    const auto        attached = from.selector.hang(nodes);
    const Points      rest     = chosen(from.mesh.get_nodes(), nodes);
    auto              track    = std::make_shared<Track>();
    track->times               = times_of(cache, handle);
    warn_of_unreached(from, track->times, handle);
    for (std::size_t k = 0; k < track->times.size(); ++k)
      track->samples.push_back(
          displacements_in(from, cache, k, rest, attached, "Handles/" + handle.name));
    warn_of_jumps(from, handle, cache, rest, *track);
    return [track](const std::vector<dealii::Point<3>> &, const double time)
    { return track->at(time); };
  }
} // namespace Exemplar
