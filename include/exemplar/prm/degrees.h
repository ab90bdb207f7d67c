// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_degrees_h
#define exemplar_degrees_h

#include <string>
#include <vector>

namespace Exemplar
{
  /// A call of sin, cos or tan whose argument looks like degrees.
  struct AngleInDegrees
  {
    std::string function; ///< "sin"
    std::string argument; ///< "90*t"
    std::string number;   ///< the part that looks like degrees: "90"
    bool        lacks_pi; ///< divides by 180 without a factor pi
  };

  /// Calls of sin, cos and tan whose argument contains a multiple of 15 >= 30, not as a divisor,
  /// and no pi. None in texts that are too long to be written by hand.
  std::vector<AngleInDegrees>
  find_degrees(const std::string &formulas);
} // namespace Exemplar

#endif
