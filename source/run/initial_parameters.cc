// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/prm/prm_tools.h>
#include <exemplar/run/initial_parameters.h>

namespace Exemplar
{
  void
  InitialParameters::declare(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Initial");
    declare_input_file(
        prm, "Pose", pose,
        "Pose at t = 0, a .msh file with the nodes and tetrahedra of the mesh; empty: "
        "the rest pose.");
    prm.add_parameter("Pose function", pose_function,
                      "Pose at t = 0 instead: x'; y'; z' as functions of the rest position x, y, z "
                      "[m].");
    prm.add_parameter("Velocity", velocity,
                      "Velocity [m/s] at t = 0 of a dynamic scene: three functions of the rest "
                      "position x, y, z [m].");
    prm.leave_subsection();
  }
} // namespace Exemplar
