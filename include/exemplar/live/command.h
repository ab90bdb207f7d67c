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
  /// What a viewer asks of the simulation, as doc/live.md describes it; what a type does not need is empty.
  struct Command
  {
    std::string               type;
    std::string               name     = {}; ///< of a spring, a pin, a handle or a number
    std::vector<unsigned int> vertices = {}; ///< of the surface
    std::vector<double>       numbers  = {};
    unsigned int              triangle = 0; ///< of the surface
    unsigned int              sequence = 0; ///< of the pointer, which frames give back
    bool                      on       = false;
  };

  /// The command in the text of a message. Throws std::invalid_argument, in words for the viewer, for
  /// what is none: types, names of numbers and counts are checked here, what depends on the body is not.
  Command
  parse_command(std::string_view message);
} // namespace Exemplar::Live

#endif
