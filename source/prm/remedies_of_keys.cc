// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/nearest_word.h>
#include <exemplar/prm/key_table.h>
#include <exemplar/prm/remedies.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <regex>

namespace Exemplar
{
  std::string
  letters_of(const std::string &text)
  {
    std::string result;
    for (const char c : text)
      if (std::isalnum(static_cast<unsigned char>(c)) != 0)
        result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return result;
  }

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

    /// Whether the documentation begins with the symbol and its unit, as "rho [kg/m^3]".
    bool
    has_symbol(const DeclaredKey &key, const std::string &symbol)
    {
      return symbol.size() <= 3
             && (" " + key.documentation).substr(0, 40).find(" " + symbol + " [")
                    != std::string::npos;
    }

    constexpr std::size_t far = std::numeric_limits<std::size_t>::max();

    /// Edit distance of a written key to a declared one; `far` if it is too great.
    std::size_t
    name_distance(const std::string &written, const DeclaredKey &key)
    {
      const std::string a = letters_of(written), b = letters_of(key.key);
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

    /// Whether a key is in another outermost section.
    bool
    is_outside(const std::string &section, const DeclaredKey &key)
    {
      return section.substr(0, section.find('/')) != key.subsections[0];
    }

    /// The nearest keys: by names first, then by sections.
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
          continue;            // another section means a key of that section
        const std::size_t cost // section names have fewer than 100 letters
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
                                    + section
                                    + (section == "Obstacles" ? "/NAME/Shape" : "/NAME/Select")
                                    + (section == "Loads"  ? " and Loads/NAME/Force. "
                                       : section == "Ties" ? " and Ties/NAME/To. "
                                                           : " and " + section + "/NAME/Motion. "));
    }
  } // namespace

  std::string
  remedy_of_key(const std::string              &path,
                const std::vector<DeclaredKey> &keys,
                const std::string              &option_value)
  {
    const std::string usual_remedy = "exemplar --print-parameters lists them all.";
    if (path.size() > 200) // not hand-written, too long for regular expressions
      return usual_remedy;
    if (letters_of(path) == "threads" || letters_of(path) == "nthreads")
      return "The number of threads is given by --threads, behind the scene.";
    const bool        has_slash = path.find('/') != std::string::npos;
    const std::string usual
        = has_slash ? path : std::regex_replace(path, std::regex("[.:>]+"), "/");
    std::string remedy  = usual == path ? "" : "Sections and keys are separated by '/'. ";
    const Path  written = split_path(usual);
    const std::vector<std::string> nearest = nearest_keys(written, keys);
    if (written.section.rfind("Handles/", 0) == 0 && letters_of(written.key) == "velocity")
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
} // namespace Exemplar
