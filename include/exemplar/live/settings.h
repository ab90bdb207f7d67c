// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_settings_h
#define exemplar_live_settings_h

#include <exemplar/exemplar.h>
#include <exemplar/live/command.h>
#include <exemplar/run/session/session.h>

#include <map>
#include <string>
#include <utility>
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

  /// A property of the cells as one number.
  struct NumberOfCells
  {
    double mean;
    bool   varies; ///< whether it differs between cells
  };

  NumberOfCells
  young_of(const Problem &problem);

  NumberOfCells
  poisson_of(const Problem &problem);

  /// Numbers of the whole body that viewers set by sliders, and their bounds.
  class Settings
  {
  public:
    /// Takes a problem at its beginning, whose values determine the bounds.
    explicit Settings(const Problem &problem);

    /// The event of a command that sets a number. Throws std::invalid_argument, in words for the
    /// viewer, for a number that cannot be set, or not to this value.
    SessionEvent
    event_of(const Command &command, const Problem &problem) const;

    using Bounds = std::map<std::string, std::pair<double, double>>;

    const Bounds &
    get_bounds() const
    {
      return bounds;
    }

    /// Whether the importance is at its lower bound, where the examples hardly act.
    bool
    is_without_examples(const Problem &problem) const;

  private:
    const Bounds bounds; ///< bounds by name of the number
  };

  /// An event before the next step of the problem, when all events of a hand are done.
  SessionEvent
  before_next_step(const Problem            &problem,
                   const std::string        &what,
                   const std::string        &name    = "",
                   std::vector<unsigned int> nodes   = {},
                   std::vector<double>       numbers = {});
} // namespace Exemplar::Live

#endif
