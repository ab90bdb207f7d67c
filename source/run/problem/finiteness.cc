// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/run/problem/finiteness.h>

#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// Whether all of an array's numbers are finite. Larger ones than these have no square, and
    /// energies are made of squares.
    template <typename Numbers>
    bool
    are_finite(const Numbers &numbers)
    {
      return max_entry(numbers.begin(), numbers.end()) < 1e150;
    }
  } // namespace

  std::string
  what_is_not_finite(const State &state, const Evaluation &evaluation)
  {
    if (!are_finite(state.positions))
      return "positions";
    if (!are_finite(state.velocities))
      return "velocities";
    if (!are_finite(state.weights) || !are_finite(state.multipliers))
      return "weights";
    const ElasticEvaluation &elastic = evaluation.elastic;
    if (!std::isfinite(elastic.energy) || !std::isfinite(elastic.energy_elastic)
        || !std::isfinite(evaluation.potential))
      return "energies";
    if (!std::isfinite(elastic.min_det_F))
      return "ratios of volumes";
    return "";
  }

  std::string
  what_is_not_finite(const CellResults &cells)
  {
    const auto some_are_not
        = [](const std::vector<double> &numbers) { return !std::isfinite(max_entry(numbers)); };
    if (some_are_not(cells.strain_energy_density))
      return "densities of energy";
    if (some_are_not(cells.det_F))
      return "ratios of volumes";
    if (some_are_not(cells.von_mises_stress))
      return "stresses";
    if (some_are_not(cells.plastic_strain))
      return "plastic strains";
    return "";
  }
} // namespace Exemplar
