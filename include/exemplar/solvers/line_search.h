// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_line_search_h
#define exemplar_line_search_h

#include <exemplar/potential/incremental_potential.h>

namespace Exemplar
{
  /// Merit of a state in a line search: the potential with the best weights, and its gradient.
  struct Merit
  {
    double potential         = 0.; ///< [J]
    double rounding          = 0.; ///< of the potential, beyond that of sums [J]
    double max_free_gradient = 0.; ///< [N]

    Merit() = default;

    Merit(const IncrementalPotential &potential, const Evaluation &evaluation)
        : potential(evaluation.potential),
          rounding(potential.get_body().rounding_energy(evaluation.elastic)
                   + evaluation.rounding_energy),
          max_free_gradient(potential.get_free_dofs().max_magnitude(evaluation.gradient))
    {
    }
  };

  /// Whether a step has led downhill. `change_expected` < 0 is what the slope at its beginning
  /// promised.
  bool
  is_better(const Merit &now, const Merit &before, double change_expected);

  /// Whether such a change of the potential is too near its rounding to be seen.
  bool
  is_below_rounding(const Merit &before, double change_expected);

  /// Whether a step has led downhill where the change of the potential is lost in rounding: by the slopes at both
  /// ends of a step of that length, of which half the sum is the mean slope of a quadratic function (the approximate Wolfe
  /// condition of Hager and Zhang, SIAM J. Optim. 16, 2005). Off a saddle point the potential falls
  /// and the gradient grows, which is_better() would refuse.
  bool
  is_better_by_slopes(
      const Merit &now, const Merit &before, double slope_before, double slope_now, double length);

  /// Draw the free degrees of freedom of `to` [m] back towards `from`, to as much of the way as
  /// IncrementalPotential::max_step() allows. Held ones stay where their handles have put them. Throws SolverFailure
  /// where a term does not let these go there. `displacement` is memory, and overwritten.
  void
  keep_within_max_step(const IncrementalPotential &potential,
                       const Vector               &from,
                       Vector                     &to,
                       Vector                     &displacement);

  /// keep_within_max_step() with memory of its own.
  inline void
  keep_within_max_step(const IncrementalPotential &potential, const Vector &from, Vector &to)
  {
    Vector displacement;
    keep_within_max_step(potential, from, to, displacement);
  }
} // namespace Exemplar

#endif
