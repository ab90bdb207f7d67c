// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_surface_materials_h
#define exemplar_live_surface_materials_h

#include <exemplar/live/run_motion.h>

#include <array>
#include <map>
#include <optional>

namespace Exemplar::Live
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

  /// The materials in the libraries (mtllib) of a surface, which are looked for in the run's
  /// directory, then in that of the surface. Missing libraries and materials are told in `notes`.
  std::map<std::string, SurfaceMaterial>
  materials_of(const MovingSurface         &moving,
               const std::filesystem::path &run,
               std::vector<std::string>    &notes);
} // namespace Exemplar::Live

#endif
