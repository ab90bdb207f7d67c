// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/solvers/line_search.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    bool
    has_not_risen(const Merit &now, const Merit &before)
    {
      return now.potential
             <= before.potential + std::max(1e-12 * std::abs(before.potential), before.rounding);
    }

    constexpr unsigned int max_halvings_beside_held = 20;

    /// A displacement of which free nodes go a part.
    Vector
    with_part_of_free(const FreeDofs &free_dofs, Vector displacement, const double part)
    {
      for (const unsigned int dof : free_dofs.local_list())
        displacement[dof] *= part;
      return displacement;
    }
  } // namespace

  bool
  is_below_rounding(const Merit &before, const double change_expected)
  {
    return std::abs(change_expected) < std::max(1e-9 * std::abs(before.potential), before.rounding);
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
  keep_within_max_step(const IncrementalPotential &potential,
                       const Vector               &from,
                       Vector                     &to,
                       Vector                     &displacement)
  {
    displacement = to;
    displacement -= from;
    double part = potential.max_step(from, displacement);
    if (part >= 1.)
      return;
    const FreeDofs &free_dofs     = potential.get_free_dofs();
    const Vector    of_held       = with_part_of_free(free_dofs, displacement, 0.);
    const bool      is_held_moved = free_dofs.exchange().any(!of_held.all_zero());
    if (const std::string name = is_held_moved ? potential.name_of_limit(from, of_held) : "";
        !name.empty())
      throw SolverFailure(
          "Handles cannot move their nodes so far in a step: the term '" + name
          + "' does not let them. Take smaller steps, or move the handles another way.");
    // beside held nodes, which go all of their way, free ones may have to go less
    Vector kept = with_part_of_free(free_dofs, displacement, part);
    for (unsigned int halving = 0; is_held_moved && potential.max_step(from, kept) < 1.; ++halving)
    {
      part = halving < max_halvings_beside_held ? 0.5 * part : 0.;
      kept = with_part_of_free(free_dofs, displacement, part);
    }
    to = from;
    to += kept;
  }
} // namespace Exemplar
