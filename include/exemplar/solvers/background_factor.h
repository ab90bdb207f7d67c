// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_background_factor_h
#define exemplar_background_factor_h

#include <exemplar/algebra/bordered_system.h>

#include <future>
#include <memory>
#include <vector>

namespace Exemplar
{
  /// The next system of a step, which a thread of its own factorises while the last one is in use. When it is
  /// taken is for the caller to say, by counts, so that results do not depend on how fast the thread was.
  class BackgroundFactor
  {
  public:
    /// The next system, with values and columns to be overwritten before start(); null if `last` has no twin. A
    /// factor that was not taken is lost. It is good as long as the pattern of `last` is.
    BorderedSystem *
    prepare(const BorderedSystem &last);

    /// Factorise what prepare() gave, with few digits.
    void
    start(const Vector &positions);

    /// Wait for the factor, and exchange its system for the last one. Returns A^-1 times the columns of its weights.
    /// Throws SolverFailure if there is none.
    std::vector<double>
    take(std::unique_ptr<BorderedSystem> &last);

    /// The pattern has changed: forget the system, after the thread has left it.
    void
    clear();

  private:
    void
    wait();

    std::unique_ptr<BorderedSystem>  next;
    std::future<std::vector<double>> future; ///< whose thread has ended when it does, before `next`
  };

  /// A^-1 times the columns of the weights, by a system that was just factorised.
  std::vector<double>
  inverse_columns(BorderedSystem &system);
} // namespace Exemplar

#endif
