// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_space_error_h
#define exemplar_space_error_h

#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Estimated error of a state of linear elements due to the mesh.
  struct SpaceError
  {
    double displacement = 0.; ///< norm of the correction, relative to the corrected displacement's
    double energy = 0.; ///< of the potential, relative to the corrected energy, doc/choosing.md
    std::optional<double> weights;        ///< greatest change of an unknown weight
    std::vector<double>   energy_density; ///< of the correction's strain, by cell [J/m^3]

    /// Why there is no estimate; else empty.
    std::string failure = {};
  };
} // namespace Exemplar

#endif
