// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_agreement_h
#define exemplar_agreement_h

#include <exemplar/algebra/exchange.h>

#include <functional>

namespace Exemplar
{
  /// Run `action` on every process that shares the body. If it throws on any of them, all throw
  /// what the first of these threw: UserError, SolverFailure, or std::runtime_error for anything
  /// else. Collective.
  void
  do_in_agreement(const Exchange &exchange, const std::function<void()> &action);

  /// As do_in_agreement(), with an action that the root alone runs.
  void
  do_at_root(const Exchange &exchange, const std::function<void()> &action);
} // namespace Exemplar

#endif
