// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_finiteness_h
#define exemplar_finiteness_h

#include <exemplar/body/state.h>
#include <exemplar/potential/elastic_potential.h>
#include <exemplar/potential/evaluation.h>

#include <string>

// What a run writes are finite numbers: a state that is none is not accepted.

namespace Exemplar
{
  /// What of a state and of what was found at it is not finite, in words; empty if all is.
  std::string
  what_is_not_finite(const State &state, const Evaluation &evaluation);

  /// The same of what frames show of the cells.
  std::string
  what_is_not_finite(const CellResults &cells);
} // namespace Exemplar

#endif
