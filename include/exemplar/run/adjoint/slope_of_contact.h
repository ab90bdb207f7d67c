// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_slope_of_contact_h
#define exemplar_slope_of_contact_h

#include <exemplar/run/adjoint/slope_derivatives.h>
#include <exemplar/run/problem/obstacle_start.h>

// The slope of what obstacles do to the body, and the body to itself.

namespace Exemplar
{
  /// Add the slope of barriers and friction at the problem's state. Friction needs a step that
  /// potential.begin_step() has begun, of which the state is the end.
  void
  add_slope_of_contact(const Problem &problem, const Direction &direction, SlopeDerivatives &sums);

  /// Whether rest positions, by which problems are made anew, have a known effect on how obstacles, and widths of pairs of
  /// the body, suit it where it begins.
  bool
  knows_starts_in_contact(const Problem &problem);
} // namespace Exemplar

#endif
