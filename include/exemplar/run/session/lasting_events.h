// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_lasting_events_h
#define exemplar_lasting_events_h

#include <exemplar/run/session/session.h>

#include <map>
#include <optional>
#include <utility>

namespace Exemplar
{
  /// What events of a session lead to without the steps between them, in as few events as there are springs,
  /// handles and numbers that they speak of. A hand of half an hour moves some springs 60,000 times.
  class LastingEvents
  {
  public:
    /// In the order in which it was done.
    void
    add(const SessionEvent &event);

    /// These lead a body to where all that was added would, but for what the solver remembers.
    Session
    get() const;

  private:
    /// Of a spring, a handle or a number: the last event that makes it anew, and those after it.
    struct Subject
    {
      std::optional<SessionEvent> made, moved, ended;
    };

    std::vector<Subject> subjects; ///< in the order of their first events
    std::map<std::pair<std::string, std::string>, std::size_t> indices; ///< by kind and name
  };
} // namespace Exemplar

#endif
