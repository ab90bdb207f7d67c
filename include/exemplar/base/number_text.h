// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_number_text_h
#define exemplar_number_text_h

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
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

  /// A number with three digits, for messages.
  inline std::string
  short_text(const double value)
  {
    char buffer[32];
    std::snprintf(buffer, sizeof(buffer), "%.3g", value);
    return buffer;
  }

  /// NaN unless the whole text is a number.
  inline double
  parse_number(const std::string &text)
  {
    char        *end    = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    return !text.empty() && end == text.c_str() + text.size() ? number : std::nan("");
  }
} // namespace Exemplar

#endif
