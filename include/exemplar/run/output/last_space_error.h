// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_last_space_error_h
#define exemplar_last_space_error_h

#include <exemplar/run/problem/space_error_estimator.h>

#include <optional>

namespace Exemplar
{
  /// The error in space of the present step, where Output/Space error asks for it.
  class LastSpaceError
  {
  public:
    /// The problem must outlive this.
    explicit LastSpaceError(Problem &problem) : problem(problem), estimator(problem) {}

    /// Estimate the error unless it is known, if the scene asks for it at the present step.
    void
    find(bool has_frame);

    /// Estimate the error at the end of a run, which may come before the last step.
    void
    find_at_end();

    /// Drop the estimate after another step.
    void
    forget()
    {
      error.reset();
    }

    /// The estimate; nothing if it has not been asked for.
    const std::optional<SpaceError> &
    get() const
    {
      return error;
    }

  private:
    Problem                  &problem;
    SpaceErrorEstimator       estimator;
    std::optional<SpaceError> error;
  };
} // namespace Exemplar

#endif
