// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/handle_parameters.h>
#include <exemplar/prm/expression.h>
#include <exemplar/prm/key_table.h>

namespace Exemplar
{
  void
  HandleParameters::declare(KeyTable &keys)
  {
    keys.enter_subsection(name);
    select.declare(keys, "The nodes that the handle holds");
    keys.add("Motion", motion,
             "Displacement [m] of the held nodes from their rest position: three functions "
             "of the rest position x, y, z [m] and of t [s].",
             "; ");
    keys.add("Components", components,
             "The components that are held; fewer than x, y, z make a roller or a plane of "
             "symmetry.");
    keys.add("Slopes", slopes,
             "Of a shell: held: the normals at edges whose two nodes are held turn with the "
             "handle, as in a clamp or a "
             "plane of symmetry; free: the shell turns about these edges as about a hinge; auto: "
             "held where Components "
             "are x, y, z and no cache is followed, which has no normals; else free.");
    keys.add_file("Follow pose", follow_pose,
                  "A .msh file with the nodes and tetrahedra of the mesh, or a surface as in "
                  "Examples/Poses: the held nodes go to their places in this pose, turned and "
                  "moved rigidly together, instead of "
                  "by Motion.");
    keys.add("Progress", progress,
             "How far the nodes are on the way to the pose that they follow, a function "
             "of t [s]: 0 at rest, 1 in the pose.");
    keys.add_file("Follow cache", follow_cache,
                  "Where the vertices of Mesh/Surface are in time, such as the output of a rig: a "
                  ".mdd or .pc2 file or a sequence of surfaces, rig_*.obj. The held nodes hang on "
                  "the surface and go where it goes, linearly between samples, instead of by "
                  "Motion; before the first sample and after the last they rest.");
    keys.add("Frames per second", frames_per_second,
             "What makes seconds of the frames of a .pc2 file and of a sequence, whose numbers are "
             "its frames, the first one at t = 0; .mdd files have seconds.",
             Bounds::positive());
    keys.add("Cache start", cache_start,
             "t [s] of the first sample of the cache; file: as the file has it.");
    keys.add("From", from,
             "t [s] from which on the nodes are held: caught where they are then, they move from "
             "there as Motion does from this time on. 0: from the beginning, at their places.",
             Bounds{ 0. });
    keys.add("Until", until,
             "t [s] at which the nodes are let go, with the velocities that they have; end: never. "
             "Before From: let go first, and caught again at From. Steps that begin in between are "
             "free.");
    keys.leave_subsection();
  }

  bool
  HandleParameters::holds_slopes() const
  {
    return slopes == "held"
           || (slopes == "auto" && components == HandleParameters().components
               && follow_cache.empty());
  }

  HoldingTime
  HandleParameters::holding_time() const
  {
    HoldingTime time;
    time.from = from;
    if (until != "end")
      time.until = parse_number(until);
    return time;
  }

  void
  HandleParameters::check_time(const std::string &key) const
  {
    if (until == "end")
      return;
    if (!(std::isfinite(parse_number(until)) && parse_number(until) > 0.))
      throw UserError(key + "/Until = '" + until
                      + "' is not allowed. Allowed: end, or a time [s] greater than 0.");
    if (from == parse_number(until))
      throw UserError(
          key + "/From and " + key + "/Until are both " + until
          + ", so nothing is ever let go. Set From to 0 and Until to end, or other times.");
  }

  void
  HandleParameters::check() const
  {
    const std::string key = "Handles/" + name;
    const bool        has_motion
        = split_formulas(motion, 3) != split_formulas(HandleParameters().motion, 3);
    if (!follow_cache.empty() && (has_motion || !follow_pose.empty()))
      throw UserError(key + "/Follow cache and " + key
                      + (has_motion ? "/Motion = '" + motion + "'" : "/Follow pose")
                      + " are both given, but only one of them can say where the nodes go. Remove "
                        "one of them.");
    if (cache_start != "file" && !std::isfinite(parse_number(cache_start)))
      throw UserError(key + "/Cache start = '" + cache_start
                      + "' is not allowed. Allowed: file, or a time [s].");
    if (follow_cache.empty()
        && (cache_start != "file" || frames_per_second != HandleParameters().frames_per_second))
      throw UserError(key + "/" + (cache_start != "file" ? "Cache start" : "Frames per second")
                      + " is given, but no " + key
                      + "/Follow cache. Give the cache that is followed, or remove it.");
    if (slopes != "auto" && slopes != "held" && slopes != "free")
      throw UserError(key + "/Slopes = '" + slopes
                      + "' is not allowed. Allowed: auto, held, free.");
    check_time(key);
    if (!follow_pose.empty() && has_motion)
      throw UserError(key + "/Follow pose and " + key + "/Motion = '" + motion
                      + "' are both given, but only one of them can say where the nodes go. Remove "
                        "one of them.");
    if (follow_pose.empty() && progress != HandleParameters().progress)
      throw UserError(key + "/Progress = '" + progress + "' is given, but no " + key
                      + "/Follow pose. Give the pose that is followed, or remove Progress and put "
                        "the function of t into Motion.");
  }
} // namespace Exemplar
