// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_session_h
#define exemplar_session_h

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// An interactive action on a body between two steps. The meaning of nodes and numbers depends on
  /// `what`; see SessionPlayer.
  struct SessionEvent
  {
    unsigned int              step; ///< number of the step that follows the event
    std::string               what; ///< "grab", "move", ...
    std::string               name; ///< of a spring or a handle; may be empty
    std::vector<unsigned int> nodes;
    std::vector<double>       numbers;
    unsigned int              line = 0; ///< of the session file; 0: none
  };

  /// Events in chronological order.
  using Session = std::vector<SessionEvent>;

  /// A line of a session file: STEP | WHAT | NAME | NODES | NUMBERS, numbers in full precision.
  std::string
  line_of(const SessionEvent &event);

  /// The inverse of line_of(). Throws UserError, with the place of the line, if it cannot be
  /// parsed.
  SessionEvent
  event_of_line(const std::string &line, const std::string &place);

  /// The first lines of a session file.
  std::string
  head_of_session();

  /// Contents of a session file.
  struct RecordedSession
  {
    Session                  events;
    std::vector<std::string> warnings; ///< of an incomplete last line, which is left out
  };

  /// Throws UserError, with the line, for a file that is no session, or whose steps do not ascend.
  RecordedSession
  read_session(const std::filesystem::path &file);

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
