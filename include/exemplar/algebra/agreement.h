// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_agreement_h
#define exemplar_agreement_h

#include <exemplar/algebra/exchange.h>

#include <functional>

namespace Exemplar
{
  /// Do something, and throw in all processes that share a body what it throws in the first of them:
  /// UserError, SolverFailure, or std::runtime_error for anything else. All processes must call it.
  void
  do_in_agreement(const Exchange &exchange, const std::function<void()> &action);

  /// The same with what the root alone does.
  void
  do_at_root(const Exchange &exchange, const std::function<void()> &action);
} // namespace Exemplar

#endif
