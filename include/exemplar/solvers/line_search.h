// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_line_search_h
#define exemplar_line_search_h

#include <exemplar/potential/incremental_potential.h>

namespace Exemplar
{
  /// By what a step is judged: the potential with the best weights, and its gradient.
  struct Merit
  {
    double potential;         ///< [J]
    double max_free_gradient; ///< [N]

    Merit(const IncrementalPotential &potential, const Evaluation &evaluation)
        : potential(evaluation.potential),
          max_free_gradient(potential.max_free_gradient(evaluation))
    {
    }
  };

  /// Whether a step has led downhill. `change_expected` < 0 is what the slope at its beginning
  /// promised.
  bool
  is_better(const Merit &now, const Merit &before, double change_expected);
} // namespace Exemplar

#endif
