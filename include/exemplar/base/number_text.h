// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_number_text_h
#define exemplar_number_text_h

#include <charconv>
#include <cmath>
#include <string>

namespace Exemplar
{
  /// A number with as many digits as tell it from its neighbours; empty if it is not
  /// finite, because no file of ours holds a NaN.
  inline std::string
  shortest_text(const double value)
  {
    if (!std::isfinite(value))
      return "";
    char       buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof(buffer), value).ptr;
    return { buffer, end };
  }
} // namespace Exemplar

#endif
