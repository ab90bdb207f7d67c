// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/solvers/background_factor.h>

namespace Exemplar
{
  std::vector<double>
  inverse_columns(BorderedSystem &system)
  {
    std::vector<double> columns = system.columns();
    if (!columns.empty())
      system.apply_inverse(columns);
    return columns;
  }

  BorderedSystem *
  BackgroundFactor::prepare(const BorderedSystem &last)
  {
    wait();
    if (next == nullptr)
      next = last.twin();
    return next.get();
  }

  void
  BackgroundFactor::start(const Vector &positions)
  {
    future = std::async(std::launch::async,
                        [this, positions]
                        {
                          next->factorize_roughly(positions);
                          return inverse_columns(*next);
                        });
  }

  std::vector<double>
  BackgroundFactor::take(std::unique_ptr<BorderedSystem> &last)
  {
    std::vector<double> columns = future.get();
    std::swap(last, next);
    return columns;
  }

  void
  BackgroundFactor::clear()
  {
    wait();
    next.reset();
  }

  void
  BackgroundFactor::wait()
  {
    if (future.valid())
      future.wait();
    future = {};
  }
} // namespace Exemplar
