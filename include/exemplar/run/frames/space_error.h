// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_space_error_h
#define exemplar_space_error_h

#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// An estimate of how far a state of linear elements is from that of ever finer meshes.
  struct SpaceError
  {
    double displacement = 0.; ///< norm of the correction over that of the corrected displacement
    double energy       = 0.; ///< of the potential, over the corrected energy, doc/choosing.md
    std::optional<double> weights;        ///< greatest change of a weight; of unknown weights alone
    std::vector<double>   energy_density; ///< of the correction's strain, by cell [J/m^3]

    /// Why there is no estimate; else empty.
    std::string failure = {};
  };
} // namespace Exemplar

#endif
