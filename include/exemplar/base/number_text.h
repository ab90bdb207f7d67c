// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_number_text_h
#define exemplar_number_text_h

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace Exemplar
{
  /// The shortest decimal text that reproduces a number; empty if it is not finite, because no file
  /// of ours holds a NaN.
  inline std::string
  shortest_text(const double value)
  {
    if (!std::isfinite(value))
      return "";
    char       buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof(buffer), value).ptr;
    return { buffer, end };
  }

  /// A number with three digits, for messages; without a power of ten below a million.
  inline std::string
  short_text(const double value)
  {
    char       buffer[32];
    const bool is_whole = std::abs(value) >= 999.5 && std::abs(value) < 1e6;
    std::snprintf(buffer, sizeof(buffer), is_whole ? "%.0f" : "%.3g", value);
    return buffer;
  }

  /// A place "(x, y, z)" by three digits a coordinate, for messages.
  template <typename Place>
  std::string
  place_text(const Place &x)
  {
    return "(" + short_text(x[0]) + ", " + short_text(x[1]) + ", " + short_text(x[2]) + ")";
  }

  /// The number that the whole text represents: no blanks, no sign +, no infinity, no NaN, and
  /// nothing outside the range of the type. Fractions and powers of ten only where the type has
  /// them.
  template <typename Number>
  std::optional<Number>
  decimal_number(const std::string_view text)
  {
    Number     number{};
    const auto end  = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, number);
    if (read.ec != std::errc() || read.ptr != end || !std::isfinite(static_cast<double>(number)))
      return std::nullopt;
    return number;
  }

  /// The number that the whole text represents, or NaN.
  inline double
  parse_number(const std::string &text)
  {
    char        *end    = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    return !text.empty() && end == text.c_str() + text.size() ? number : std::nan("");
  }
} // namespace Exemplar

#endif
