// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_export_command_h
#define exemplar_export_command_h

#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Options of `exemplar export`. Either `html` or `gltf` is given.
  struct ExportOptions
  {
    std::vector<std::string>    runs; ///< output directories
    std::string                 html; ///< file of the page
    std::string                 gltf; ///< file of the shapes and their weights, of one run
    std::optional<unsigned int> n_shapes;
    bool                        with_normals = false;
  };

  /// Write what shows runs elsewhere, and print its accuracy. Throws UserError with nothing
  /// written.
  void
  export_runs(const ExportOptions &options);
} // namespace Exemplar

#endif
