// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/nearest_word.h>
#include <exemplar/base/number_text.h>
#include <exemplar/prm/expression.h>
#include <exemplar/prm/key_table.h>
#include <exemplar/prm/remedies.h>

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <regex>

namespace Exemplar
{
  namespace
  {
    // Corrections of common mistakes.

    std::string
    replaced(const std::string &text, const std::string &pattern, const std::string &by)
    {
      return std::regex_replace(text, std::regex(pattern), by);
    }

    /// The allowed names of a key; empty if it is no choice.
    std::vector<std::string>
    choices_of(const DeclaredKey &key)
    {
      if (key.allowed == "true or false")
        return { "true", "false" };
      static const std::regex list("one or more of (.*), each once.*");
      return split_trimmed(std::regex_replace(key.allowed, list, "$1"), ',');
    }

    /// The allowed names nearest to those in a value; empty if one has no near one.
    std::string
    nearest_choices(const DeclaredKey &key, const std::string &value)
    {
      const std::vector<std::string> choices = choices_of(key);
      std::string                    names;
      for (const std::string &word : split_trimmed(value, ','))
      {
        std::string nearest = nearest_word(word, choices);
        for (const std::string &choice : choices) // as in Newton-Raphson
          if (nearest.empty() && letters_of(word).find(letters_of(choice)) != std::string::npos)
            nearest = choice;
        if (nearest.empty())
          return "";
        names += (names.empty() ? "" : ", ") + nearest;
      }
      return names;
    }

    std::string
    truth(const std::string &value)
    {
      const std::string word = letters_of(value);
      return word == "yes" || word == "on" || word == "1"   ? "true"
             : word == "no" || word == "off" || word == "0" ? "false"
                                                            : "";
    }

    /// The number as a person would write it, without rounding errors of a product.
    std::string
    written(const double number)
    {
      const std::string digits = fmt::format("{:.12g}", number);
      return replaced(shortest_text(parse_number(digits)), "e\\+0*", "e");
    }

    /// The fraction for a percentage; empty for other texts.
    std::string
    share(const std::string &value)
    {
      const double percent = parse_number(trim(replaced(value, "%$", "")));
      return value.back() == '%' || percent >= 2. ? shortest_text(percent / 100.) : "";
    }

    /// The value of a formula without variables; empty for other texts.
    std::string
    computed(const std::string &value)
    {
      try
      {
        return written(Expression("", value, "t", 1).values({}, std::nan(""))[0]);
      }
      catch (const std::exception &)
      {
        return "";
      }
    }

    struct Unit
    {
      const char *name, *base;
      double      factor;
    };

    constexpr Unit units[]
        = { { "Pa", "Pa", 1. },         { "kPa", "Pa", 1e3 },    { "MPa", "Pa", 1e6 },
            { "GPa", "Pa", 1e9 },       { "N/m2", "Pa", 1. },    { "N/mm2", "Pa", 1e6 },
            { "bar", "Pa", 1e5 },       { "s", "s", 1. },        { "ms", "s", 1e-3 },
            { "min", "s", 60. },        { "1/s", "1/s", 1. },    { "m", "m", 1. },
            { "cm", "m", 1e-2 },        { "mm", "m", 1e-3 },     { "kg/m3", "kg/m^3", 1. },
            { "g/cm3", "kg/m^3", 1e3 }, { "m/s2", "m/s^2", 1. }, { "g", "m/s^2", 9.81 },
            { "J", "J", 1. },           { "J/m3", "J/m^3", 1. } };

    /// The unit of a key's number, from its documentation.
    std::string
    unit_of(const DeclaredKey &key)
    {
      static const std::regex bracket("\\[([^\\] ]+)");
      std::smatch             found;
      return std::regex_search(key.documentation, found, bracket) ? found.str(1) : "";
    }

    /// Numbers with units, converted to the unit of a key; empty for other texts.
    std::string
    without_units(const DeclaredKey &key, const std::string &value)
    {
      std::string numbers, last;
      for (const std::string &part : split_trimmed(value, ','))
      {
        char             *end    = nullptr;
        const double      number = std::strtod(part.c_str(), &end);
        const std::string name   = replaced(replaced(trim(end), "\\^|\\*", ""), "\xC2\xB2", "2");
        const Unit *const unit   = std::find_if(std::begin(units), std::end(units),
                                                [&](const Unit &u) {
                                                return replaced(name, "\xC2\xB3", "3") == u.name
                                                       && unit_of(key) == u.base;
                                              });
        if (end == part.c_str() || (!name.empty() && unit == std::end(units)))
          return "";
        numbers += (numbers.empty() ? "" : ", ")
                   + written(name.empty() ? number : number * unit->factor);
      }
      return numbers;
    }

    /// A number such as 1e3 as an integer; empty for other texts.
    std::string
    whole(const std::string &value)
    {
      const double number = parse_number(value);
      return std::abs(number) < 2e9 && number == std::floor(number)
                 ? fmt::format("{}", static_cast<long>(number))
                 : "";
    }

    struct Change
    {
      std::string value, words;
    };

    std::vector<Change>
    changes(const DeclaredKey &key, const std::string &value)
    {
      const std::string point = "The decimal sign is a point.";
      return {
        { replaced(value, "^[\"'](.*)[\"']$", "$1"), "Values have no quotes." },
        { replaced(value, "\\s*[;,]$", ""), "No sign ends a line." },
        { replaced(value, "\\s*;?\\s*\\bset .*", ""), "A line sets one key." },
        { replaced(value, "\\s*(//|;).*", ""), "A comment begins with #." },
        { std::regex_match(value, std::regex("[1-9]\\d{0,2}([,_' ]\\d{3})+"))
              ? replaced(value, "[,_' ]", "")
              : "",
          "Digits are not grouped, and the decimal sign is a point." },
        { replaced(value, "^([-+.\\d]+)[dD]([-+]?\\d+)$", "$1e$2"), "Powers of ten have an e." },
        { replaced(value, "^([^,]*),([^,]*)$", "$1.$2"), point },
        { replaced(value, "(\\d),(\\d)", "$1.$2"), point },
        { replaced(value, "\\s*[;x*]\\s*|\\s+", ", "), "Separate them by commas." },
        { replaced(value, "^\\s*[\\[({](.*)[\\])}]\\s*$", "$1"), "No brackets are needed." },
        { whole(value), "Write all digits." },
        { nearest_choices(key, value), "" },
        { truth(value), "" },
        { share(value), "It is a share of 1, not of 100." },
        { without_units(key, value), "Write the number alone, in " + unit_of(key) + "." },
        { std::isnan(parse_number(value)) ? computed(value) : "", "No formula is allowed here." },
        { replaced(value, "^-\\s*", ""), "It cannot be negative." },
        { key.path() == "Loads/Gravity" ? replaced(value, "^-?([.\\d]+)$", "0, 0, -$1") : "",
          "It is a vector." }
      };
    }

    bool
    is_number_with_unit(const std::string &value)
    {
      char *end = nullptr;
      std::strtod(value.c_str(), &end);
      const std::string rest = trim(end);
      return end != value.c_str() && !rest.empty()
             && std::isalpha(static_cast<unsigned char>(rest[0])) != 0;
    }

    std::string
    first_sentence(const std::string &text)
    {
      std::size_t end = text.find(". ");
      while (end < text.size() - 2 && std::isupper(static_cast<unsigned char>(text[end + 2])) == 0)
        end = text.find(". ", end + 1); // such as after "e.g."
      return end == std::string::npos ? text : text.substr(0, end + 1);
    }

    /// The meaning of a key: the first sentence of its documentation.
    std::string
    meaning(const DeclaredKey &key, const std::string &value)
    {
      const bool is_number = key.allowed.find("number") != std::string::npos
                             || key.allowed.find("integer") != std::string::npos;
      std::string hint;
      if (is_number && is_number_with_unit(value))
        hint = " Write the number alone, without its unit.";
      if (!is_number && value.find_first_of("0123456789") != std::string::npos)
        hint = " It is a choice of these words, not a number.";
      return hint + " Its meaning: " + first_sentence(key.documentation);
    }
  } // namespace

  std::string
  remedy_of_value(const DeclaredKey                              &key,
                  const std::string                              &value,
                  const std::function<bool(const std::string &)> &is_allowed)
  {
    if (!value.empty() && value.size() < 200)
      for (const Change &change : changes(key, value))
        if (!change.value.empty() && change.value != value && is_allowed(change.value))
          return " " + change.words + (change.words.empty() ? "" : " ") + "Did you mean '"
                 + change.value + "'?";
    return meaning(key, value);
  }
} // namespace Exemplar
