// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/potential/weight_energy.h>

#include <cmath>

namespace Exemplar
{
  void
  add_weight_energy(const ExampleWeights      &energy,
                    const std::vector<double> &norms,
                    const std::vector<double> &weights,
                    ElasticEvaluation         &result)
  {
    const WeightMemory               &memory      = energy.get_memory();
    const double                      stress_norm = std::sqrt(result.stress_square);
    const dealii::FullMatrix<double> &form        = energy.penalty_matrix();
    for (unsigned int v = 0; v < form.m(); ++v)
    {
      double penalty = 0.;
      for (unsigned int w = 0; w < form.m(); ++w)
        penalty += form(v, w) * weights[w];
      result.energy += 0.5 * penalty * weights[v];
      result.weight_gradient[v] += penalty + memory.force(v, weights[v]);
      result.weight_scale
          = max_or_nan(result.weight_scale, stress_norm * norms[v] + std::abs(penalty)
                                                + memory.force_scale(v, weights[v]));
    }
    result.energy_memory = memory.energy(weights);
  }

  void
  set_weight_gradient(const ExampleWeights      &energy,
                      const std::vector<double> &weights,
                      const std::vector<double> &linear_term,
                      ElasticEvaluation         &result)
  {
    const dealii::FullMatrix<double> &H = energy.weight_form().H;
    for (unsigned int v = 0; v < H.m(); ++v)
    {
      result.weight_gradient[v] = -linear_term[v];
      for (unsigned int w = 0; w < H.m(); ++w)
        result.weight_gradient[v] += H(v, w) * weights[w];
    }
  }
} // namespace Exemplar
