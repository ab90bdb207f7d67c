// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/solvers/line_search.h>

#include <cmath>

namespace Exemplar
{
  namespace
  {
    bool
    has_not_risen(const Merit &now, const Merit &before)
    {
      return now.potential <= before.potential + 1e-12 * std::abs(before.potential);
    }
  } // namespace

  bool
  is_below_rounding(const Merit &before, const double change_expected)
  {
    return std::abs(change_expected) < 1e-9 * std::abs(before.potential);
  }

  bool
  is_better(const Merit &now, const Merit &before, const double change_expected)
  {
    // the potential cannot tell any more, but the gradient can
    if (is_below_rounding(before, change_expected))
      return has_not_risen(now, before) && now.max_free_gradient < before.max_free_gradient;
    return now.potential <= before.potential + 1e-4 * change_expected; // Armijo
  }

  bool
  is_better_by_slopes(const Merit &now,
                      const Merit &before,
                      const double slope_before,
                      const double slope_now,
                      const double length)
  {
    return is_below_rounding(before, length * slope_before) && has_not_risen(now, before)
           && 0.5 * (slope_before + slope_now) <= 1e-4 * slope_before;
  }

  void
  keep_within_max_step(const IncrementalPotential &potential, const Vector &from, Vector &to)
  {
    Vector displacement = to;
    displacement -= from;
    const double part = potential.max_step(from, displacement);
    if (part >= 1.)
      return;
    for (const unsigned int dof : potential.get_free_dofs().local_list())
      to[dof] = from[dof] + part * displacement[dof];
  }
} // namespace Exemplar
