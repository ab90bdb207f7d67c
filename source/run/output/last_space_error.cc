// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/output/last_space_error.h>

namespace Exemplar
{
  void
  LastSpaceError::find(const bool has_frame)
  {
    const SpaceErrorUse use          = problem.parameters.output.space_error;
    const bool          is_last      = problem.state.step == problem.time_axis.n_steps();
    const bool          is_asked_for = use != SpaceErrorUse::never
                              && (is_last || (use == SpaceErrorUse::in_frames && has_frame));
    if (is_asked_for && !error)
      error = estimator.estimate();
  }

  void
  LastSpaceError::find_at_end()
  {
    if (problem.state.step < problem.time_axis.n_steps())
      forget();
    find(false);
  }
} // namespace Exemplar
