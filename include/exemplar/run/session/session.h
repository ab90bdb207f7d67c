// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_session_h
#define exemplar_session_h

#include <filesystem>
#include <string>
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
} // namespace Exemplar

#endif
