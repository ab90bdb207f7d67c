// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/prm/key_table.h>
#include <exemplar/run/scene/initial_parameters.h>

namespace Exemplar
{
  void
  InitialParameters::declare(KeyTable &keys)
  {
    keys.enter_subsection("Initial");
    keys.add_file(
        "Pose", pose,
        "Pose at t = 0, a .msh file with the nodes and tetrahedra of the mesh, or a surface "
        "as in Examples/Poses; empty: the rest pose.");
    keys.add("Pose function", pose_function,
             "Pose at t = 0 instead: x'; y'; z' as functions of the rest position x, y, z "
             "[m].",
             "; ");
    keys.add("Velocity", velocity,
             "Velocity [m/s] at t = 0 of a dynamic scene: three functions of the rest "
             "position x, y, z [m].",
             "; ");
    keys.leave_subsection();
  }
} // namespace Exemplar
