// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/body/handle_parameters.h>
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
             "of the rest position x, y, z [m] and of t [s].");
    keys.add("Components", components,
             "The components that are held; fewer than x, y, z make a roller or a plane of "
             "symmetry.");
    keys.add_file("Follow pose", follow_pose,
                  "A .msh file with the nodes and tetrahedra of the mesh, or a surface as in "
                  "Examples/Poses: the held nodes go to their places in this pose, turned and "
                  "moved rigidly together, instead of "
                  "by Motion.");
    keys.add("Progress", progress,
             "How far the nodes are on the way to the pose that they follow, a function "
             "of t [s]: 0 at rest, 1 in the pose.");
    keys.leave_subsection();
  }

  void
  HandleParameters::check() const
  {
    const std::string key = "Handles/" + name;
    if (!follow_pose.empty()
        && split_trimmed(motion, ';') != split_trimmed(HandleParameters().motion, ';'))
      throw UserError(key + "/Follow pose and " + key + "/Motion = '" + motion
                      + "' are both given, but only one of them can say where the nodes go. Remove "
                        "one of them.");
    if (follow_pose.empty() && progress != HandleParameters().progress)
      throw UserError(key + "/Progress = '" + progress + "' is given, but no " + key
                      + "/Follow pose. Give the pose that is followed, or remove Progress and put "
                        "the function of t into Motion.");
  }
} // namespace Exemplar
