// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_output_parameters_h
#define exemplar_output_parameters_h

#include <string>
#include <vector>

namespace Exemplar
{
  class KeyTable;

  /// The tetrahedra of final.msh.
  enum class FinalTetrahedra
  {
    linear,   ///< those of the mesh file
    quadratic ///< with 10 nodes each
  };

  /// When the error in space is estimated.
  enum class SpaceErrorUse
  {
    never,
    at_end,
    in_frames ///< in frames and at the end
  };

  /// Subsection Output.
  struct OutputParameters
  {
    std::string              directory;
    unsigned int             every              = 1;
    std::vector<std::string> formats            = { "vtu" }; ///< names in frame_formats()
    bool                     usd_cells          = true;      ///< whether usda has the tetrahedra
    bool                     usd_normals        = true; ///< whether usda has normals in each frame
    double                   checkpoint_minutes = 5.;
    bool                     keep_states        = false; ///< one for each frame
    FinalTetrahedra          final_pose         = FinalTetrahedra::linear;
    SpaceErrorUse            space_error        = SpaceErrorUse::never;
    std::string              functional         = {}; ///< see make_functional(); empty: none

    void
    declare(KeyTable &keys);

    /// Whether a frame is written in a format that shows the surface of the body.
    bool
    shows_surface() const;
  };
} // namespace Exemplar

#endif
