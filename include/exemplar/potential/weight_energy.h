// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_weight_energy_h
#define exemplar_weight_energy_h

#include <exemplar/body/example_weights.h>
#include <exemplar/potential/evaluation.h>

#include <vector>

namespace Exemplar
{
  /// Add the energy of the weights alone to an evaluation of a body: their penalty and their memory, with the
  /// derivatives, and the scale of these. `norms` are ExampleTargets::norms().
  void
  add_weight_energy(const ExampleWeights      &energy,
                    const std::vector<double> &norms,
                    const std::vector<double> &weights,
                    ElasticEvaluation         &result);

  /// Let the derivatives by the weights be H w - c.
  void
  set_weight_gradient(const ExampleWeights      &energy,
                      const std::vector<double> &weights,
                      const std::vector<double> &linear_term,
                      ElasticEvaluation         &result);
} // namespace Exemplar

#endif
