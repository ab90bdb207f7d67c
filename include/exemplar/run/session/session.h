// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_session_h
#define exemplar_session_h

#include <filesystem>
#include <string>
#include <vector>

namespace Exemplar
{
  /// One thing that a hand did to a body between two steps. What nodes and numbers mean depends on
  /// `what`; SessionPlayer knows it.
  struct SessionEvent
  {
    unsigned int              step; ///< before which it was done: that which ends with this number
    std::string               what; ///< "grab", "move", ...
    std::string               name; ///< of a spring or a handle; may be empty
    std::vector<unsigned int> nodes;
    std::vector<double>       numbers;
    unsigned int              line = 0; ///< of the file from which it was read; 0: none
  };

  /// In the order in which it was done.
  using Session = std::vector<SessionEvent>;

  /// A line of a session file: STEP | WHAT | NAME | NODES | NUMBERS, the numbers with all their digits.
  std::string
  line_of(const SessionEvent &event);

  /// The opposite. Throws UserError, with the place of the line, for what is none.
  SessionEvent
  event_of_line(const std::string &line, const std::string &place);

  /// With what a session file begins.
  std::string
  head_of_session();

  /// What a session file holds.
  struct RecordedSession
  {
    Session events;
    std::vector<std::string>
        warnings; ///< of a last line that was not written whole, which is left out
  };

  /// Throws UserError, with the line, for what is no session, or for steps that do not ascend.
  RecordedSession
  read_session(const std::filesystem::path &file);
} // namespace Exemplar

#endif
