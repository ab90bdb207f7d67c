// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_weight_sliders_h
#define exemplar_live_weight_sliders_h

#include <exemplar/exemplar.h>
#include <exemplar/run/session/session.h>

#include <vector>

namespace Exemplar::Live
{
  /// Weights of the examples set by sliders. Sliders may jump; weights follow them at a limited
  /// speed.
  class WeightSliders
  {
  public:
    /// Sets target weights, one for each example, the same in all regions; empty: steps find the
    /// weights again. Returns the event to be done at once. Throws std::invalid_argument, in words
    /// for the viewer, for weights that the scene does not allow.
    SessionEvent
    want(const std::vector<double> &values, const Problem &problem);

    /// Moves the weights towards their targets before the next step; no events if they are there.
    Session
    follow(const Problem &problem);

    bool
    are_in_use() const
    {
      return !to.empty();
    }

    /// Target weights of all regions; empty: not in use.
    const std::vector<double> &
    wanted() const
    {
      return to;
    }

  private:
    std::vector<double> at, to; ///< weights and targets of all regions; empty: not in use
  };
} // namespace Exemplar::Live

#endif
