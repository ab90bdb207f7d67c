// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_export_gltf_h
#define exemplar_live_export_gltf_h

#include <exemplar/live/crossings.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar::Live
{
  /// What is to be written.
  struct GltfOptions
  {
    std::filesystem::path       run;  ///< its output directory
    std::filesystem::path       file; ///< .glb
    std::optional<unsigned int> n_shapes;
    bool                        with_normals = false;
  };

  /// What a file holds.
  struct GltfReport
  {
    std::size_t n_frames = 0, n_examples = 0, n_shapes = 0;
    std::size_t n_vertices     = 0; ///< of the surfaces, in whose order the file has them
    std::size_t n_copies       = 0; ///< behind them, where a vertex has several texture points
    std::size_t n_bytes        = 0;
    double      error          = 0.; ///< largest distance of a vertex from its frame [m]
    double      relative_error = 0.; ///< over the diagonal of the body at rest
    std::size_t n_obstacles    = 0;
    std::optional<Crossings> crossings = {}; ///< of a run with contact
    std::vector<std::string> warnings;
  };

  /// Write the motion of a run as binary glTF 2.0: examples and shapes as morph targets with keyed
  /// weights, see KeyedShapes. Throws UserError, with nothing written, where motion_of_run() does,
  /// and for an existing file that exemplar has not written.
  GltfReport
  export_gltf(const GltfOptions &options);
} // namespace Exemplar::Live

#endif
