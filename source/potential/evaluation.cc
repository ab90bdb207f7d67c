// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/evaluation.h>

#include <algorithm>

namespace Exemplar
{
  ElasticEvaluation
  complete(const Exchange &exchange, ElasticSums &&sums)
  {
    ElasticEvaluation   result = std::move(*sums);
    std::vector<double> all    = { result.energy_elastic,
                                   result.energy,
                                   result.energy_damping,
                                   result.energy_inelastic,
                                   result.stress_square,
                                   static_cast<double>(result.inverted_cells),
                                   static_cast<double>(result.guarded_cells) };
    const std::size_t   n      = all.size();
    all.insert(all.end(), result.weight_gradient.begin(), result.weight_gradient.end());
    exchange.sum(all);
    result.energy_elastic   = all[0];
    result.energy           = all[1];
    result.energy_damping   = all[2];
    result.energy_inelastic = all[3];
    result.stress_square    = all[4];
    result.inverted_cells   = static_cast<unsigned int>(all[5]);
    result.guarded_cells    = static_cast<unsigned int>(all[6]);
    std::copy(all.begin() + n, all.end(), result.weight_gradient.begin());
    result.min_det_F = min_of_all(exchange, result.min_det_F);
    exchange.assemble(result.gradient.begin(), 3);
    exchange.assemble(result.force_scale.begin(), 1);
    return result;
  }
} // namespace Exemplar
