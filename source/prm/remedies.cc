// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/nearest_word.h>
#include <exemplar/base/number_text.h>
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

    /// The keys that are nearest: by their names first, then by their sections.
    std::vector<std::string>
    nearest_keys(const Path &written, const std::vector<DeclaredKey> &keys)
    {
      std::vector<std::string> nearest;
      std::size_t              least = far;
      for (const DeclaredKey &key : keys)
      {
        const std::size_t distance = name_distance(written.key, key);
        if (distance == far)
          continue;
        const std::string section = split_path(key.path()).section;
        const std::size_t cost // names of sections have less than 100 letters
            = 100 * distance
              + (written.section.empty() ? 0 : edit_distance(written.section, section));
        if (cost < least)
          nearest.clear();
        least = std::min(least, cost);
        if (cost == least)
          nearest.push_back(key.path());
      }
      return nearest;
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

    std::string
    section_in_words(const std::string &section, const std::vector<DeclaredKey> &keys)
    {
      const std::string names = section.empty() ? "" : keys_of(section, keys);
      return names.empty() ? "" : "Section " + section + " has the keys " + names + ". ";
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
        const std::string nearest = nearest_word(word, choices);
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

    /// The number that a percentage or a fraction is, as text; empty for other texts.
    std::string
    computed(const std::string &value)
    {
      const std::string number = trim(replaced(value, "%$", ""));
      if (const double percent = parse_number(number); std::isfinite(percent))
        return value.back() == '%' || percent >= 2. ? shortest_text(percent / 100.) : "";
      const std::vector<std::string> parts = split_trimmed(value, '/');
      return parts.size() == 2 ? short_text(parse_number(parts[0]) / parse_number(parts[1])) : "";
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
      return { { replaced(value, "^[\"'](.*)[\"']$", "$1"), "Values have no quotes." },
               { replaced(value, "\\s*[;,]$", ""), "No sign ends a line." },
               { replaced(value, "\\s*//.*", ""), "A comment begins with #." },
               { replaced(value, "^([^,]*),([^,]*)$", "$1.$2"), point },
               { replaced(value, "(\\d),(\\d)", "$1.$2"), point },
               { replaced(value, "\\s*[;x*]\\s*|\\s+", ", "), "Separate them by commas." },
               { replaced(value, "^\\s*[\\[({](.*)[\\])}]\\s*$", "$1"), "No brackets are needed." },
               { whole(value), "Write all digits." },
               { nearest_choices(key, value), "" },
               { truth(value), "" },
               { computed(value), value.find('/') == std::string::npos
                                      ? "It is a share of 1, not of 100."
                                      : "No formula is allowed here." },
               { replaced(value, "^-\\s*", ""), "It cannot be negative." } };
    }

    bool
    is_number_with_unit(const std::string &value)
    {
      static const std::regex pattern("[-+]?[0-9.]+([eE][-+]?[0-9]+)? *[A-Za-z].*");
      return std::regex_match(value, pattern);
    }

    /// The first sentence of what a number means, with its unit; empty for what is no number.
    std::string
    meaning(const DeclaredKey &key, const std::string &value)
    {
      if (key.allowed.find("number") == std::string::npos
          && key.allowed.find("integer") == std::string::npos)
        return "";
      return (is_number_with_unit(value) ? " Write the number alone, without its unit."
                                         : std::string())
             + " Its meaning: " + key.documentation.substr(0, key.documentation.find(". "))
             + (key.documentation.find(". ") == std::string::npos ? "" : ".");
    }
  } // namespace

  std::string
  remedy_of_key(const std::string &path, const std::vector<DeclaredKey> &keys)
  {
    const std::string usual_remedy = "exemplar --print-parameters lists them all.";
    if (path.size() > 200) // no key of a person, and too much for regular expressions
      return usual_remedy;
    const bool        has_slash = path.find('/') != std::string::npos;
    const std::string usual     = has_slash ? path : replaced(path, "[.:>]+", "/");
    std::string       remedy    = usual == path ? "" : "Sections and keys are separated by '/'. ";
    const Path        written   = split_path(usual);
    const std::vector<std::string> nearest = nearest_keys(written, keys);
    if (!nearest.empty())
    {
      remedy += "Did you mean '";
      for (std::size_t i = 0; i < std::min<std::size_t>(nearest.size(), 4); ++i)
        remedy += (i == 0 ? "" : "' or '") + nearest[i];
      remedy += "'? ";
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
