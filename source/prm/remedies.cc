// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/nearest_word.h>
#include <exemplar/base/number_text.h>
#include <exemplar/prm/expression.h>
#include <exemplar/prm/key_table.h>
#include <exemplar/prm/remedies.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <regex>
#include <set>

namespace Exemplar
{
  namespace
  {
    struct Path
    {
      std::string section, key;
    };

    Path
    split_path(const std::string &path)
    {
      const std::size_t slash = path.rfind('/');
      return slash == std::string::npos ? Path{ "", path }
                                        : Path{ path.substr(0, slash), path.substr(slash + 1) };
    }

    /// The letters and digits of a text: people write YoungsModulus, youngs_modulus and the like.
    std::string
    letters(const std::string &text)
    {
      std::string result;
      for (const char c : text)
        if (std::isalnum(static_cast<unsigned char>(c)) != 0)
          result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      return result;
    }

    /// Whether the documentation begins with the symbol and its unit, as "rho [kg/m^3]".
    bool
    has_symbol(const DeclaredKey &key, const std::string &symbol)
    {
      return symbol.size() <= 3
             && (" " + key.documentation).substr(0, 40).find(" " + symbol + " [")
                    != std::string::npos;
    }

    constexpr std::size_t far = std::numeric_limits<std::size_t>::max();

    /// How far what was written for a key is from its name; `far` if it was not meant.
    std::size_t
    name_distance(const std::string &written, const DeclaredKey &key)
    {
      const std::string a = letters(written), b = letters(key.key);
      if (a == b || has_symbol(key, written))
        return 0;
      const bool contains = std::min(a.size(), b.size()) >= 4
                            && (a.find(b) != std::string::npos || b.find(a) != std::string::npos);
      return contains ? 1 : is_near(a, b) ? edit_distance(a, b) : far;
    }

    std::string
    keys_of(const std::string &section, const std::vector<DeclaredKey> &keys)
    {
      std::string names;
      for (const DeclaredKey &key : keys)
        if (split_path(key.path()).section == section)
          names += (names.empty() ? "" : ", ") + key.key;
      return names;
    }

    /// Whether a key is of another outermost section.
    bool
    is_outside(const std::string &section, const DeclaredKey &key)
    {
      return section.substr(0, section.find('/')) != key.subsections[0];
    }

    /// The keys that are nearest: by their names first, then by their sections.
    std::vector<std::string>
    nearest_keys(const Path &written, const std::vector<DeclaredKey> &keys)
    {
      std::vector<std::string> nearest;
      std::size_t              minimum = far;
      for (const DeclaredKey &key : keys)
      {
        const std::size_t distance = name_distance(written.key, key);
        const std::string section  = split_path(key.path()).section;
        const bool is_of_others    = key.subsections.size() > 1 && is_outside(written.section, key);
        if (distance == far
            || ((distance > 0 || is_of_others) && section != written.section
                && !keys_of(written.section, keys).empty()))
          continue;            // who names another section means a key of it
        const std::size_t cost // names of sections have less than 100 letters
            = 100 * distance
              + (written.section.empty() ? 0 : edit_distance(written.section, section));
        if (cost < minimum)
          nearest.clear();
        minimum = std::min(minimum, cost);
        if (cost == minimum)
          nearest.push_back(key.path());
      }
      return nearest;
    }

    std::string
    section_in_words(const std::string &section, const std::vector<DeclaredKey> &keys)
    {
      const std::string names = section.empty() ? "" : keys_of(section, keys);
      return names.empty()
                 ? ""
                 : "Section " + section + " has the keys " + names
                       + (names.find("Names") == std::string::npos
                              ? ". "
                              : "; what Names lists has keys of its own, in a subsection "
                                "each, such as "
                                    + section + "/NAME/Select"
                                    + (section == "Loads" ? " and Loads/NAME/Force. "
                                                          : " and " + section + "/NAME/Motion. "));
    }

    // What common mistakes become when they are undone.

    std::string
    replaced(const std::string &text, const std::string &pattern, const std::string &by)
    {
      return std::regex_replace(text, std::regex(pattern), by);
    }

    /// The names that a key allows, if it is a choice of them.
    std::vector<std::string>
    choices_of(const DeclaredKey &key)
    {
      if (key.allowed == "true or false")
        return { "true", "false" };
      static const std::regex list("one or more of (.*), each once.*");
      return split_trimmed(std::regex_replace(key.allowed, list, "$1"), ',');
    }

    /// The names nearest to those that a value gives; empty if one of them is far from all.
    std::string
    nearest_choices(const DeclaredKey &key, const std::string &value)
    {
      const std::vector<std::string> choices = choices_of(key);
      std::string                    names;
      for (const std::string &word : split_trimmed(value, ','))
      {
        std::string nearest = nearest_word(word, choices);
        for (const std::string &choice : choices) // Newton-Raphson
          if (nearest.empty() && letters(word).find(letters(choice)) != std::string::npos)
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
      const std::string word = letters(value);
      return word == "yes" || word == "on" || word == "1"   ? "true"
             : word == "no" || word == "off" || word == "0" ? "false"
                                                            : "";
    }

    /// As a person writes it: rounding errors of a product are left out.
    std::string
    written(const double number)
    {
      char digits[32];
      std::snprintf(digits, sizeof(digits), "%.12g", number);
      return replaced(shortest_text(parse_number(digits)), "e\\+0*", "e");
    }

    /// The share of one that a percentage is; empty for other texts.
    std::string
    share(const std::string &value)
    {
      const double percent = parse_number(trim(replaced(value, "%$", "")));
      return value.back() == '%' || percent >= 2. ? shortest_text(percent / 100.) : "";
    }

    /// The number that a formula without variables gives; empty for other texts.
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

    /// The unit of a key's number, by its documentation.
    std::string
    unit_of(const DeclaredKey &key)
    {
      static const std::regex bracket("\\[([^\\] ]+)");
      std::smatch             found;
      return std::regex_search(key.documentation, found, bracket) ? found.str(1) : "";
    }

    /// Numbers with units, in the unit of a key; empty for other texts.
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

    /// 1e3 is an integer, too.
    std::string
    whole(const std::string &value)
    {
      const double number = parse_number(value);
      return std::abs(number) < 2e9 && number == std::floor(number)
                 ? std::to_string(static_cast<long>(number))
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
        end = text.find(". ", end + 1); // such as behind "e.g."
      return end == std::string::npos ? text : text.substr(0, end + 1);
    }

    /// What a key means: the first sentence of its documentation.
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
  remedy_of_key(const std::string              &path,
                const std::vector<DeclaredKey> &keys,
                const std::string              &option_value)
  {
    const std::string usual_remedy = "exemplar --print-parameters lists them all.";
    if (path.size() > 200) // no key of a person, and too much for regular expressions
      return usual_remedy;
    if (letters(path) == "threads" || letters(path) == "nthreads")
      return "The number of threads is given by --threads, behind the scene.";
    const bool        has_slash = path.find('/') != std::string::npos;
    const std::string usual     = has_slash ? path : replaced(path, "[.:>]+", "/");
    std::string       remedy    = usual == path ? "" : "Sections and keys are separated by '/'. ";
    const Path        written   = split_path(usual);
    const std::vector<std::string> nearest = nearest_keys(written, keys);
    if (written.section.rfind("Handles/", 0) == 0 && letters(written.key) == "velocity")
      remedy += "A handle is moved by Motion, displacements [m] that are formulas of t. ";
    if (!nearest.empty())
    {
      for (std::size_t i = 0; i < std::min<std::size_t>(nearest.size(), 4); ++i)
        remedy += (i == 0 ? "Did you mean " : " or ")
                  + (option_value.empty() ? "'" + nearest[i] + "'"
                                          : "--set \"" + nearest[i] + option_value + "\"");
      remedy += "? ";
      if (split_path(nearest[0]).section != written.section)
        remedy += section_in_words(written.section, keys);
    }
    else
      remedy += section_in_words(keys_of(usual, keys).empty() ? written.section : usual, keys);
    return remedy + usual_remedy;
  }

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
