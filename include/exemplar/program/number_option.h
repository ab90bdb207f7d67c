// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_number_option_h
#define exemplar_number_option_h

#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <cmath>
#include <regex>
#include <string>
#include <type_traits>

namespace Exemplar
{
  /// Text of a bound of an option, for messages.
  template <typename Number>
  std::string
  bound_text(const Number bound)
  {
    if constexpr (std::is_integral<Number>::value)
      return fmt::format("{}", bound);
    else
      return shortest_text(bound);
  }

  /// "Did you mean N? " with the integer for a text such as 1e4 or 10,000; empty for other texts.
  inline std::string
  meant_number(const std::string &text, const double minimum, const double maximum)
  {
    static const std::regex groups("[1-9]\\d{0,2}([,_']\\d{3})+");
    const bool              has_groups = text.size() < 30 && std::regex_match(text, groups);
    const std::string       digits
        = has_groups ? std::regex_replace(text, std::regex("[,_']"), "") : text;
    const double number = parse_number(digits);
    return number == std::floor(number) && number >= minimum && number <= maximum
               ? fmt::format("Did you mean {}? ", static_cast<long long>(number))
               : "";
  }

  /// Declare an option that takes a decimal number from `minimum` to `maximum`: CLI11 itself would
  /// accept NaN in any range, and octal and hexadecimal numbers. Other texts lead to a UserError
  /// with `remedy`, a sentence with a trailing blank. `target` may be a std::optional.
  template <typename Target, typename Number>
  CLI::Option *
  add_number_option(CLI::App          &app,
                    const std::string &name,
                    Target            &target,
                    const Number       minimum,
                    const Number       maximum,
                    const std::string &description,
                    const std::string &remedy = "")
  {
    const std::string command = app.get_parent() == nullptr ? "" : app.get_name() + " ";
    const auto read = [&target, name, minimum, maximum, remedy, command](const std::string &text)
    {
      const bool is_whole = std::is_integral<Number>::value;
      const auto number   = decimal_number<Number>(text);
      if (!number || *number < minimum || *number > maximum)
        throw UserError(name + ": expected a " + (is_whole ? "whole number" : "number") + " from "
                        + bound_text(minimum) + " to " + bound_text(maximum)
                        + " in decimal digits, found " + in_quotes(text) + ". "
                        + (is_whole ? meant_number(text, minimum, maximum) : "") + remedy
                        + "exemplar " + command + "--help lists what is allowed.");
      target = *number;
    };
    return app.add_option_function<std::string>(name, read, description)
        ->type_name(std::is_integral<Number>::value ? "UINT" : "FLOAT");
  }
} // namespace Exemplar

#endif
