// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/obstacles/contact_parameters.h>
#include <exemplar/obstacles/obstacle_parameters.h>
#include <exemplar/obstacles/obstacle_shape.h>
#include <exemplar/prm/key_table.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  void
  ObstacleParameters::declare(KeyTable &keys)
  {
    keys.enter_subsection(name);
    keys.add(
        "Shape", shape,
        "What the body may not pass: " + obstacle_forms
            + ". A plane is given by a point and by the normal of the side on which the body is; "
              "FILE (.obj, .ply, .stl) is in the unit of the mesh file.",
        " ");
    keys.add("Motion", motion, "Displacement [m], three functions of t [s].", "; ");
    keys.add(
        "Turn", turn,
        "Rotation vector [rad], three functions of t [s], about the point of a plane, the middle "
        "of other shapes.",
        "; ");
    keys.add_file(
        "Follow cache", follow_cache,
        "Places of the vertices of a surface in time: a .mdd or .pc2 file, or a sequence of "
        "surfaces such as rig_*.obj, in the unit of the mesh file. Instead of Motion and "
        "Turn.");
    keys.add_file(
        "Follow track", follow_track,
        "A rigid motion in frames: a file of lines of t [s], a displacement and a rotation vector "
        "[rad], as Motion and Turn have them, or of t and the three rows of a matrix (R p), which "
        "takes x to R x + p; lengths in the unit of the mesh file. Linear between frames, at rest "
        "before the first and after the last. Instead of Motion and Turn.");
    keys.add("Frames per second", frames_per_second, "Of a cache that counts in frames.",
             Bounds::positive());
    keys.add("Friction", friction, "Coefficient of Coulomb's friction.");
    keys.add("From", from, "The obstacle is there in steps that begin at this t [s] or later.");
    keys.add("Until", until,
             "The obstacle is there in steps that begin before this t [s]; end: to the end.");
    keys.leave_subsection();
  }

  void
  ObstacleParameters::check() const
  {
    const std::string key = "Obstacles/" + name;
    if (shape.empty())
      throw UserError(key + "/Shape is not set. Allowed: " + obstacle_forms + ".");
    if (surface_file().empty())
    {
      parse_shape(shape, key + "/Shape");
      if (!follow_cache.empty())
        throw UserError(key + "/Follow cache gives the places of a surface's vertices, but " + key
                        + "/Shape = '" + shape
                        + "' is no surface. Set Motion and Turn instead, or Shape = surface FILE.");
    }
    check_friction(friction, key + "/Friction");
    const ObstacleParameters usual;
    std::vector<std::string> movers; // the keys that say where it goes
    for (const auto &[mover, given] : { std::pair("/Follow cache", !follow_cache.empty()),
                                        std::pair("/Follow track", !follow_track.empty()),
                                        std::pair(motion != usual.motion ? "/Motion" : "/Turn",
                                                  motion != usual.motion || turn != usual.turn) })
      if (given)
        movers.push_back(key + mover);
    if (movers.size() > 1)
      throw UserError(movers[0] + " and " + movers[1]
                      + " are both given, but only one of them can say where the obstacle goes. "
                        "Remove one of them.");
    if (until != "end" && !std::isfinite(parse_number(until)))
      throw UserError(key + "/Until = '" + until
                      + "' is not allowed. Allowed: end, or a time [s].");
    if (until != "end" && parse_number(until) <= from)
      throw UserError(key + "/Until = " + until + " is not after " + key
                      + "/From = " + shortest_text(from) + ": the obstacle would never be there.");
  }

  bool
  ObstacleParameters::stays() const
  {
    const ObstacleParameters usual;
    return motion == usual.motion && turn == usual.turn && follow_cache.empty()
           && follow_track.empty();
  }

  HoldingTime
  ObstacleParameters::time() const
  {
    HoldingTime result;
    result.from = from;
    if (until != "end")
      result.until = parse_number(until);
    return result;
  }

  std::string
  ObstacleParameters::surface_file() const
  {
    return file_of_shape(shape);
  }

  std::string
  ObstacleParameters::absolute_shape(const std::string           &shape,
                                     const std::filesystem::path &directory)
  {
    const std::string file = file_of_shape(shape);
    if (file.empty() || directory.empty())
      return shape;
    return "surface " + (directory / file).lexically_normal().string();
  }

  namespace
  {
    const EnumTable<FreeBodies> kinds_of_free = { { FreeBodies::refused, "refused" },
                                                  { FreeBodies::friction, "friction" },
                                                  { FreeBodies::weak_springs, "weak springs" } };
  } // namespace

  void
  ObstaclesParameters::declare(KeyTable &keys)
  {
    keys.add(
        "Distance", distance,
        "From where obstacles push [m]; auto: 5e-3 of the diameter of the piece that touches.");
    keys.add("Slip speed", slip_speed,
             "Speed [m/s] from which friction is that of a sliding contact: what sticks creeps "
             "below it; auto: 1e-3 of the diameter of the piece that touches, per second.");
    keys.add("Lag tolerance", lag_tolerance,
             "Friction follows normal forces until they change by less than this part of the "
             "greatest.",
             Bounds{ 1e-14, 1. });
    keys.add("Free", free, kinds_of_free,
             "Static scenes: what holds a body that handles leave free. refused: nothing does. "
             "friction: friction with obstacles. weak springs: springs to where it stands at rest, "
             "of 1e-6 of Young's modulus times its diameter.");
  }

  void
  ObstaclesParameters::check() const
  {
    check_length(distance, "Obstacles/Distance", "m");
    check_length(slip_speed, "Obstacles/Slip speed", "m/s");
    for (const ObstacleParameters &obstacle : named)
    {
      obstacle.check();
      for (const ObstacleParameters &other : named)
        if (other.name == obstacle.name + "_torque")
          throw UserError("Obstacles/Names has " + obstacle.name + " and " + other.name
                          + ", of which both have columns contact_" + other.name
                          + "_x to z in statistics.csv. Give one of them another name.");
    }
    if (free == FreeBodies::friction && !named.empty() && !has_friction())
      throw UserError("Obstacles/Free = friction, but no obstacle has friction. Set "
                      "Obstacles/NAME/Friction of one, or Obstacles/Free = weak springs.");
  }

  bool
  ObstaclesParameters::has_friction() const
  {
    return std::any_of(named.begin(), named.end(),
                       [](const ObstacleParameters &obstacle) { return obstacle.friction > 0.; });
  }
} // namespace Exemplar
