// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_weight_sliders_h
#define exemplar_live_weight_sliders_h

#include <exemplar/exemplar.h>
#include <exemplar/run/session/session.h>

#include <vector>

namespace Exemplar::Live
{
  /// Weights of the examples that a hand has set. Sliders jump, and weights follow them.
  class WeightSliders
  {
  public:
    /// One for each example, the same in all regions; empty: steps find them again. Returns what is to be done at
    /// once. Throws std::invalid_argument, in words for the viewer, for what the scene does not allow.
    SessionEvent
    want(const std::vector<double> &values, const Problem &problem);

    /// Let them come nearer before the next step; there may be nothing to do.
    Session
    follow(const Problem &problem);

    bool
    are_in_use() const
    {
      return !to.empty();
    }

    /// Where they are, or strive to, of all regions; empty: not in use.
    const std::vector<double> &
    wanted() const
    {
      return to;
    }

  private:
    std::vector<double> at, to; ///< of all regions; empty: not in use
  };
} // namespace Exemplar::Live

#endif
