// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_lasting_events_h
#define exemplar_lasting_events_h

#include <exemplar/run/session/session.h>

#include <map>
#include <optional>
#include <utility>

namespace Exemplar
{
  /// The shortest list of events with the same outcome as those of a session, the steps between
  /// them left out: at most two for each spring, handle or number. In half an hour a hand moves
  /// some springs 60,000 times.
  class LastingEvents
  {
  public:
    /// Add an event; in chronological order.
    void
    add(const SessionEvent &event);

    /// Events that bring a body to the same state as all added ones, but for the solver's memory.
    Session
    get() const;

  private:
    /// A spring, a handle or a number: the event that last created or reset it, and the last ones
    /// after it.
    struct Subject
    {
      std::optional<SessionEvent> made, moved, ended;
    };

    std::vector<Subject> subjects; ///< in the order of their first events
    std::map<std::pair<std::string, std::string>, std::size_t> indices; ///< by kind and name
  };
} // namespace Exemplar

#endif
