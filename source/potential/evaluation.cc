// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/evaluation.h>

namespace Exemplar
{
  ElasticEvaluation
  complete(const Exchange &exchange, ElasticSums &&sums)
  {
    ElasticEvaluation result = std::move(*sums);
    // behind the derivatives, which have had that memory since the first evaluation
    std::vector<double> &all = result.weight_gradient;
    const std::size_t    n   = all.size();
    for (const double number :
         { result.energy_elastic, result.energy, result.energy_damping, result.energy_inelastic,
           result.stress_square, static_cast<double>(result.inverted_cells),
           static_cast<double>(result.guarded_cells) })
      all.push_back(number);
    exchange.sum(all);
    result.energy_elastic   = all[n];
    result.energy           = all[n + 1];
    result.energy_damping   = all[n + 2];
    result.energy_inelastic = all[n + 3];
    result.stress_square    = all[n + 4];
    result.inverted_cells   = static_cast<unsigned int>(all[n + 5]);
    result.guarded_cells    = static_cast<unsigned int>(all[n + 6]);
    all.resize(n);
    result.min_det_F = min_of_all(exchange, result.min_det_F);
    exchange.assemble(result.gradient.begin(), 3);
    exchange.assemble(result.force_scale.begin(), 1);
    return result;
  }
} // namespace Exemplar
