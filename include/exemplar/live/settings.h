// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_settings_h
#define exemplar_live_settings_h

#include <exemplar/live/command.h>
#include <exemplar/run/session/session.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace Exemplar
{
  class Problem;
}

namespace Exemplar::Live
{
  /// A number that each cell has.
  struct NumberOfCells
  {
    double mean;
    bool   varies; ///< from cell to cell
  };

  NumberOfCells
  young_of(const Problem &problem);

  NumberOfCells
  poisson_of(const Problem &problem);

  /// Numbers of the whole body that viewers set by sliders, and between which bounds.
  class Settings
  {
  public:
    /// Of a scene at its beginning.
    explicit Settings(const Problem &problem);

    /// Throws std::invalid_argument, in words for the viewer, for what cannot be set, or not to this.
    SessionEvent
    event_of(const Command &command, const Problem &problem) const;

    using Bounds = std::map<std::string, std::pair<double, double>>;

    const Bounds &
    get_bounds() const
    {
      return bounds;
    }

    /// Whether the importance is so small that the body does as if it had no examples.
    bool
    is_without_examples(const Problem &problem) const;

  private:
    const Bounds bounds; ///< by names
  };

  /// The events of a hand are done before the next step of the problem.
  SessionEvent
  before_next_step(const Problem            &problem,
                   const std::string        &what,
                   const std::string        &name    = "",
                   std::vector<unsigned int> nodes   = {},
                   std::vector<double>       numbers = {});
} // namespace Exemplar::Live

#endif
