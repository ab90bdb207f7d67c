// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_material_library_h
#define exemplar_material_library_h

#include <exemplar/surface/shape/surface_mesh.h>

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// A material of an .mtl file.
  struct SurfaceMaterial
  {
    std::array<double, 3>                colour{ { 0.8, 0.8, 0.8 } }; ///< Kd
    std::array<double, 3>                emission{ { 0., 0., 0. } };  ///< Ke
    double                               opacity  = 1.;               ///< d, or 1 - Tr
    double                               exponent = 0.;               ///< Ns, 0 to 1000
    std::optional<std::filesystem::path> texture  = {};               ///< map_Kd
  };

  /// The name of each face's material, as usemtl gives it; empty: none.
  std::vector<std::string>
  material_names(const SurfaceMesh &surface);

  /// Materials by name, and the libraries that are in none of the folders.
  struct MaterialLibraries
  {
    std::map<std::string, SurfaceMaterial> materials;
    std::vector<std::string>               missing;
  };

  /// The materials in the libraries (mtllib) of a surface, each looked for in these folders.
  MaterialLibraries
  read_material_libraries(const SurfaceMesh                        &surface,
                          const std::vector<std::filesystem::path> &folders);
} // namespace Exemplar

#endif
