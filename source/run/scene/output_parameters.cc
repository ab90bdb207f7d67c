// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/prm/key_table.h>
#include <exemplar/run/frames/frame_formats.h>
#include <exemplar/run/scene/output_parameters.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    const EnumTable<FinalTetrahedra> final_poses
        = { { FinalTetrahedra::linear, "linear" }, { FinalTetrahedra::quadratic, "quadratic" } };
    const EnumTable<SpaceErrorUse> space_error_uses = { { SpaceErrorUse::never, "false" },
                                                        { SpaceErrorUse::at_end, "true" },
                                                        { SpaceErrorUse::in_frames, "frames" } };
  } // namespace

  void
  OutputParameters::declare(KeyTable &keys)
  {
    keys.enter_subsection("Output");
    keys.add("Directory", directory,
             "Where results go, relative to the working directory; empty: "
             "output/NAME of the scene file. An earlier run's files are cleared.");
    keys.add("Every", every,
             "A frame every so many steps, and of the last; 0: none (final.msh alone).",
             Bounds{ 0 });
    keys.add_choices(
        "Formats", formats, names_of(frame_formats()),
        "Formats of the frames. vtu shows the mesh, for ParaView; obj, ply, mdd, pc2 and "
        "usda show Mesh/Surface as the body carries it, in its unit and order of "
        "vertices.");
    keys.add("USD cells", usd_cells,
             "Whether usda has the body's tetrahedra as a guide, with their places in each frame.");
    keys.add("USD normals", usd_normals,
             "Whether usda has smooth normals of the surface in each frame; without them programs "
             "make their own.");
    keys.add("Checkpoint minutes", checkpoint_minutes,
             "Minutes of run time between checkpoints. One is also written at the end and "
             "on Ctrl-C.",
             Bounds{ 0. });
    keys.add(
        "Keep states", keep_states,
        "Whether the state of each frame is kept in full precision, state_NNNN.bin, from which "
        "--resume-from NNNN goes on, also with an edited scene.");
    keys.add(
        "Final pose", final_pose, final_poses,
        "linear: final.msh has the nodes and elements of the mesh; quadratic, with Model/Element "
        "= P2: also the nodes in the middles of edges, as 10-node tetrahedra and 6-node "
        "triangles. Both can be poses and initial states of other scenes.");
    keys.add("Space error", space_error, space_error_uses,
             "true: how far the mesh is from ever finer ones is estimated at the end, by a step of "
             "quadratic elements, for summary.json and the last frame; frames: in each frame, too. "
             "With Model/Element = P1. It takes two to ten times the memory of the run, the "
             "more the larger the mesh.");
    keys.add(
        "Functional", functional,
        "A number at the end of a static scene for summary.json, and how far it is from that of "
        "the exact equilibrium on this mesh, as its derivatives say: energy_elastic [J], "
        "reaction_NAME_x of a "
        "handle [N], or displacement_x of SELECTION, such as displacement_z of boundary 2, the "
        "mean of its nodes [m]; with _y and _z likewise. Empty: none.");
    keys.leave_subsection();
  }

  bool
  OutputParameters::shows_surface() const
  {
    const std::vector<FrameFormat> &known = frame_formats();
    return every > 0
           && std::any_of(known.begin(), known.end(),
                          [this](const FrameFormat &format) {
                            return format.shows_surface
                                   && std::count(formats.begin(), formats.end(), format.name) > 0;
                          });
  }
} // namespace Exemplar
