// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/body/handle.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    using Points = std::vector<dealii::Point<3>>;
    using Arms   = std::vector<dealii::Tensor<1, 3>>;

    /// A rotation of points, each of which moves on a straight line, so that they are crushed
    /// towards the axis on the way.
    struct StraightTurn
    {
      double angle;    ///< [rad], 0 if there is no such turn
      double min_size; ///< relative to the smaller one at the ends
    };

    const double degree    = std::acos(-1.) / 180.;
    const double min_angle = 20. * degree;

    /// Vectors from the centroid to the points.
    Arms
    arms(const Points &points)
    {
      const dealii::Point<3> center = centroid(points);
      Arms                   result;
      for (const dealii::Point<3> &x : points)
        result.push_back(x - center);
      return result;
    }

    /// a + factor b.
    Arms
    sum(const Arms &a, const double factor, const Arms &b)
    {
      Arms result = a;
      for (std::size_t i = 0; i < a.size(); ++i)
        result[i] += factor * b[i];
      return result;
    }

    double
    product(const Arms &a, const Arms &b)
    {
      double value = 0.;
      for (std::size_t i = 0; i < a.size(); ++i)
        value += a[i] * b[i];
      return value;
    }

    /// Components perpendicular to the axis.
    Arms
    across(const dealii::Tensor<1, 3> &axis, Arms all)
    {
      for (auto &arm : all)
        arm -= (arm * axis) * axis;
      return all;
    }

    /// Whether all `places` are start + s way with one number s for all points, where
    /// 0.05 < s < 0.95 at least once.
    bool
    lies_on_straight_lines(const Arms                &start,
                           const Arms                &way,
                           const std::vector<Points> &places,
                           const std::size_t          n_places)
    {
      bool is_between = false;
      for (std::size_t k = 0; k < n_places; ++k)
      {
        const Arms   moved    = sum(arms(places[k]), -1., start);
        const double progress = product(moved, way) / product(way, way);
        const Arms   rest     = sum(moved, -progress, way);
        if (product(rest, rest) > 1e-6 * product(way, way))
          return false;
        is_between = is_between || (progress > 0.05 && progress < 0.95);
      }
      return is_between;
    }

    /// Least size on the straight way, relative to the smaller of the sizes at its ends.
    double
    min_relative_size(const Arms &start, const Arms &way)
    {
      const double at_start = product(start, start), length = product(way, way);
      const double mixed    = product(start, way);
      const double at_end   = at_start + 2. * mixed + length;
      const double progress = length > 0. ? std::clamp(-mixed / length, 0., 1.) : 0.;
      const double minimum  = at_start + progress * (2. * mixed + progress * length);
      const double smaller  = std::min(at_start, at_end);
      return smaller > 0. ? std::sqrt(std::max(minimum, 0.) / smaller) : 1.;
    }

    std::string
    rounded(const double value)
    {
      return fmt::format("{}", std::lround(value));
    }

    // Points that turn by the angle a while each of them goes straight are, half way, crushed
    // to cos(a/2) of their distance from the axis. So this is a straight turn:
    // - the rigid motion nearest to the way from rest to the place that is turned most has an
    //   angle of 20 degrees or more (below, cos(a/2) is within 1.5 % of 1);
    // - relative to their centroid, all points are on the straight lines between these two, by
    //   the same fraction, in all places in between (to 1e-3; a true rotation by 20 degrees
    //   leaves its chord by 4e-2), of which there is one at least;
    // - the way shrinks them across the axis by half of what cos(a/2) does, or more: a shear
    //   turns without doing so.
    // A turn by several straight pieces is not found, nor are translations, true rotations,
    // or jumps without a place in between.
    StraightTurn
    find_straight_turn(const std::vector<dealii::Point<3>>              &rest,
                       const std::vector<std::vector<dealii::Point<3>>> &places)
    {
      const StraightTurn none{ 0., 1. };
      AxisAngle          turn{ {}, 0. };
      std::size_t        most_turned = 0;
      for (std::size_t k = 0; k < places.size(); ++k)
      {
        const AxisAngle now = axis_and_angle(best_rigid_motion(rest, places[k]).rotation);
        if (now.angle > turn.angle)
        {
          turn        = now;
          most_turned = k;
        }
      }
      if (turn.angle < min_angle || are_collinear(rest))
        return none;

      const Arms start = arms(rest);
      const Arms way   = sum(arms(places[most_turned]), -1., start);
      if (!lies_on_straight_lines(start, way, places, most_turned))
        return none;
      const double size = min_relative_size(across(turn.axis, start), across(turn.axis, way));
      return 1. - size < 0.5 * (1. - std::cos(0.5 * turn.angle)) ? none
                                                                 : StraightTurn{ turn.angle, size };
    }

    /// The angle [rad] by which `motion` turns points of the handle as a rigid body from one time
    /// to another, to and fro summed up.
    double
    turn_between(const Handle &handle, const Points &rest, const double begin, const double end)
    {
      constexpr unsigned int n_parts = 16; // the angle of each is below 180 degrees up to 8 turns
      double                 angle   = 0.;
      Points                 before;
      for (unsigned int part = 0; part <= n_parts; ++part)
      {
        Points now = rest;
        for (dealii::Point<3> &place : now)
          place += handle.motion.vector(place, begin + part * (end - begin) / n_parts);
        if (part > 0)
          angle += rigid_turn(before, now).angle;
        before = std::move(now);
      }
      return angle;
    }

    /// Rest positions of the nodes of the whole handle. All processes look at all of them, so that
    /// they report or fail alike.
    Points
    rest_of_whole(const Handle &handle, const FESpace &fe_space)
    {
      Points own = rest_positions(handle, fe_space);
      return fe_space.exchange().n_processes() == 1 ? own
                                                    : whole_handle(handle.nodes, own, fe_space);
    }

    std::string
    describe_large_turn(const Handle &handle, const FESpace &fe_space, const TimeAxis &axis)
    {
      constexpr std::size_t max_nodes = 8, max_steps = 20; // takes a millisecond
      if (handle.path || handle.function || handle.components.size() < 3)
        return {};
      Points            rest;
      const Points      all    = rest_of_whole(handle, fe_space);
      const std::size_t stride = all.size() / max_nodes + 1;
      for (std::size_t i = 0; i < all.size(); i += stride)
        rest.push_back(all[i]);
      if (rest.size() < 3 || are_collinear(rest))
        return {};
      double            maximum = 0.;
      const std::size_t n_steps = std::min<std::size_t>(axis.n_steps(), max_steps);
      for (std::size_t k = 1; k <= n_steps; ++k)
      {
        const auto step = static_cast<unsigned int>(k * axis.n_steps() / n_steps);
        maximum
            = std::max(maximum, turn_between(handle, rest, axis.time(step - 1), axis.time(step)));
      }
      if (maximum > 179.9 * degree)
        return "Handles/" + handle.name + "/Motion turns the held nodes by "
               + rounded(maximum / degree)
               + " degrees in a step, which knows only where they end: the body goes "
                 "the shorter way. Take "
               + rounded(std::ceil(maximum / (30. * degree)))
               + " times as many steps (Time/Increments, or Time/Step).";
      return {};
    }

    std::string
    describe_progress_beyond(const Handle &handle, const FESpace &, const TimeAxis &axis)
    {
      constexpr double  maximum   = 2.; // a swing goes beyond its pose, but not twice as far
      const std::size_t n_samples = std::min<std::size_t>(axis.n_steps(), 1000);
      double            farthest  = 0.5;
      for (std::size_t k = 0; handle.path && k <= n_samples; ++k)
      {
        const double time = axis.time(static_cast<unsigned int>(k * axis.n_steps() / n_samples));
        const double progress = handle.progress.values({}, time)[0];
        if (std::abs(progress - 0.5) > std::abs(farthest - 0.5))
          farthest = progress;
      }
      if (std::abs(farthest - 0.5) > maximum - 0.5)
        return "Handles/" + handle.name + "/Progress goes to " + short_text(farthest)
               + ", but 0 is at rest and 1 in the pose: the way is extrapolated far "
                 "beyond it. Let Progress end at 1, as t does in a static scene.";
      return {};
    }

    std::string
    describe_straight_turn(const Handle &handle, const FESpace &fe_space, const TimeAxis &axis)
    {
      // a rigid motion cannot be fitted to fewer components, and few points cannot be crushed; a
      // program's function knows the nodes of its process alone
      if (handle.path || handle.components.size() < 3
          || (handle.function && fe_space.exchange().n_processes() > 1))
        return {};
      const Points rest = rest_of_whole(handle, fe_space);
      if (rest.size() < 3)
        return {};
      // in long runs of large handles only some steps, to stay below a tenth of a second
      const std::size_t   max_samples = std::max<std::size_t>(20, 100000 / rest.size());
      const std::size_t   n_samples   = std::min<std::size_t>(axis.n_steps(), max_samples);
      std::vector<Points> places;
      for (std::size_t k = 0; k <= n_samples; ++k)
      {
        places.push_back(rest);
        const double time  = axis.time(static_cast<unsigned int>(k * axis.n_steps() / n_samples));
        const Arms   given = handle.function ? handle.displacements(rest, time) : Arms();
        for (std::size_t point = 0; point < rest.size(); ++point)
          places.back()[point]
              += handle.function ? given[point] : handle.motion.vector(rest[point], time);
      }
      const StraightTurn turn = find_straight_turn(rest, places);
      const std::string  key  = "Handles/" + handle.name;
      if (turn.angle > 0.)
        return key + (handle.function ? "/Follow cache" : "/Motion") + " turns the held nodes by "
               + rounded(turn.angle / degree)
               + " degrees while each of them moves on a straight line: on the way the handle is "
                 "crushed to "
               + rounded(100. * turn.min_size) + " % of its width. "
               + (handle.function
                      ? "Give the cache more samples."
                      : "Set " + key
                            + "/Follow pose instead, or write Motion with cos and sin of "
                              "the angle.");
      return {};
    }
  } // namespace

  std::vector<std::string>
  review_of_motions(const std::vector<Handle> &handles,
                    const FESpace             &fe_space,
                    const TimeAxis            &axis)
  {
    std::vector<std::string> warnings;
    const auto add = [&](std::string (*describe)(const Handle &, const FESpace &, const TimeAxis &))
    {
      for (const Handle &handle : handles)
        if (std::string warning = describe(handle, fe_space, axis); !warning.empty())
          warnings.push_back(std::move(warning));
    };
    add(describe_straight_turn);
    add(describe_large_turn);
    add(describe_progress_beyond);
    return warnings;
  }
} // namespace Exemplar
