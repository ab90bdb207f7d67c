// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_degrees_h
#define exemplar_degrees_h

#include <string>
#include <vector>

namespace Exemplar
{
  /// A sine, cosine or tangent of what looks like degrees.
  struct AngleInDegrees
  {
    std::string function; ///< "sin"
    std::string argument; ///< "90*t"
    std::string number;   ///< that looks like degrees: "90"
    bool        lacks_pi; ///< there is "/180", which would need pi
  };

  /// Those in formulas whose argument holds a whole number of fifteens, 30 or more, that is not
  /// divided by, and no pi: 30, 45, 60, 90, 180, ... None in what is too long to be written by hand.
  std::vector<AngleInDegrees>
  find_degrees(const std::string &formulas);
} // namespace Exemplar

#endif
