// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_command_h
#define exemplar_live_command_h

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace Exemplar::Live
{
  /// A request of a viewer to the simulation, see doc/live.md; members that its type does not need
  /// are empty.
  struct Command
  {
    std::string               type;
    std::string               name     = {}; ///< name of a spring, pin, handle or number
    std::vector<unsigned int> vertices = {}; ///< of the surface
    std::vector<double>       numbers  = {};
    unsigned int              triangle = 0; ///< of the surface
    unsigned int              sequence = 0; ///< sequence number of the pointer, returned by frames
    bool                      on       = false;
  };

  /// The command in the text of a message. Throws std::invalid_argument, in words for the viewer,
  /// for an invalid one: types, names of numbers and counts are checked here, agreement with the
  /// body is not.
  Command
  parse_command(std::string_view message);
} // namespace Exemplar::Live

#endif
