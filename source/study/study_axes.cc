// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/message_text.h>
#include <exemplar/study/study_axes.h>

#include <fmt/core.h>

#include <algorithm>
#include <regex>
#include <set>

namespace Exemplar
{
  namespace
  {
    std::size_t
    find_unquoted(const std::string &text, const char separator, std::size_t from = 0)
    {
      bool is_quoted = std::count(text.begin(), text.begin() + from, '"') % 2 == 1;
      for (; from < text.size(); ++from)
        if (text[from] == '"')
          is_quoted = !is_quoted;
        else if (text[from] == separator && !is_quoted)
          return from;
      return std::string::npos;
    }

    /// split_trimmed(), except that quoted separators do not count.
    std::vector<std::string>
    split_unquoted(const std::string &text, const char separator)
    {
      std::vector<std::string> parts;
      std::size_t              begin = 0;
      if (trim(text).empty())
        return parts;
      for (std::size_t end; (end = find_unquoted(text, separator, begin)) != std::string::npos;
           begin = end + 1)
        parts.push_back(trim(text.substr(begin, end - begin)));
      parts.push_back(trim(text.substr(begin)));
      return parts;
    }

    std::string
    without_quotes(const std::string &value)
    {
      const bool is_quoted = value.size() > 1 && value.front() == '"' && value.back() == '"';
      return is_quoted ? value.substr(1, value.size() - 2) : value;
    }

    void
    require_closed_quotes(const std::string &text, const std::string &place)
    {
      if (std::count(text.begin(), text.end(), '"') % 2 == 1)
        throw UserError(place
                        + ": a quotation mark is not closed. Put '\"' around values that "
                          "hold ';', '|', ',' or blanks.");
    }

    void
    require_own_key(const Assignment &assignment)
    {
      if (assignment.path() == "Output/Directory")
        throw UserError(assignment.place
                        + ": Output/Directory is not a study's to set: each of its runs has a "
                          "directory of its own. Remove it; --output moves the whole study.");
    }

    std::vector<std::string>
    split_at_blanks(const std::string &text)
    {
      std::vector<std::string> parts = split_unquoted(text, ' ');
      parts.erase(std::remove(parts.begin(), parts.end(), ""), parts.end());
      return parts;
    }

    std::vector<std::string>
    split_values(const std::string &text)
    {
      for (const char separator : { ';', ',' })
        if (find_unquoted(text, separator) != std::string::npos)
        {
          std::vector<std::string> values = split_unquoted(text, separator);
          if (values.back().empty()) // "one pass," is a single value
            values.pop_back();
          return values;
        }
      return split_at_blanks(text);
    }

    /// Throws UserError for commas that may be decimal signs: between digits without blanks, if
    /// there are blanks elsewhere or just one comma.
    void
    refuse_decimal_commas(const std::string &text, const std::string &place)
    {
      static const std::regex several("[^\";]*[0-9],[0-9][^\";]* [^\";]*"),
          one("[-+.0-9eE]*[0-9],[0-9][-+.0-9eE]*");
      if (text.size() < 1000 && (std::regex_match(text, several) || std::regex_match(text, one)))
        throw UserError(place + ": '" + text
                        + "' may have decimal commas. The decimal sign is a point, as in 0.5: '"
                        + std::regex_replace(text, std::regex("([0-9]),([0-9])"), "$1.$2")
                        + "'. If commas separate values, write a blank behind each.");
    }

    /// Throws UserError for brackets, ranges and separators of other programs' lists.
    void
    refuse_foreign_signs(const std::string &text, const std::string &place)
    {
      static const std::regex second("[^\"]*[,;] *[A-Z][^,;:=\"/]*/[^,;:=\"]*[:=][^\"]*");
      if (text.compare(0, 1, "[") == 0)
        throw UserError(place + ": '" + text
                        + "' begins with a bracket. Values have none: 0.1 0.2.");
      static const std::regex range("[-+.0-9eE]*[0-9](\\.\\.+|:)[-+.:0-9eE]*[0-9]");
      if (text.size() < 1000 && std::regex_match(text, range))
        throw UserError(place + ": '" + text
                        + "' is no value. Ranges are written out, value by value: 1 2 3 4.");
      if (text.size() < 1000 && std::regex_match(text, second))
        throw UserError(place + ": '" + text
                        + "' holds a second key. Axes of Vary are separated by '|', keys of Base "
                          "and Reference by ';'.");
    }

    /// Remedy for a value with fewer parts than keys that vary together.
    std::string
    remedy_of_joined(const std::string &value, const std::size_t n_keys)
    {
      const std::vector<std::string> words = split_at_blanks(value);
      return " Values of joined keys are joined by '+', too"
             + (words.size() == n_keys ? ": " + joined(words, " + ") + "."
                                       : ", and separated by commas.");
    }

    /// Throws UserError if three-component values are separated by commas, like their components.
    void
    refuse_split_triples(const StudyAxis &axis, const std::string &text, const std::string &place)
    {
      static const std::set<std::string> keys{ "Mesh/Box size", "Mesh/Box cells", "Loads/Gravity" };
      const std::size_t                  n = axis.values.size();
      if (axis.keys.size() > 1 || keys.count(axis.keys[0]) == 0 || n % 3 != 0
          || find_unquoted(text, ';') != std::string::npos || text.find('"') != std::string::npos)
        return;
      std::string remedy;
      for (std::size_t i = 0; i < n; ++i)
        remedy += (i == 0 ? "" : i % 3 == 0 ? "; " : ", ") + axis.values[i][0];
      throw UserError(place + ": each value of " + axis.keys[0]
                      + " has three numbers, separated by commas. Separate the values by ';': "
                      + remedy + (n == 3 ? ";" : "") + ".");
    }

    /// Parse "Section/Key: values", or "Key + Key: value + value, ...".
    StudyAxis
    parse_axis(const std::string &text, const std::string &place)
    {
      const std::string remedy
          = " Write 'Section/Key: value value ...'; axes are separated by '|'.";
      const auto colon = text.find(':');
      if (colon == std::string::npos)
        throw UserError(place + ": the axis '" + text + "' has no ':'." + remedy);
      StudyAxis axis;
      for (const std::string &key : split_trimmed(text.substr(0, colon), '+'))
        axis.keys.push_back(parse_assignment(key + "=", place).path());
      if (axis.keys.empty())
        throw UserError(place + ": the axis '" + text + "' names no key." + remedy);
      refuse_foreign_signs(trim(text.substr(colon + 1)), place + ": " + axis.name());
      refuse_decimal_commas(trim(text.substr(colon + 1)), place + ": " + axis.name());
      for (const std::string &value : split_values(trim(text.substr(colon + 1))))
      {
        axis.values.push_back(axis.keys.size() > 1 ? split_unquoted(value, '+')
                                                   : std::vector<std::string>{ value });
        for (std::string &part : axis.values.back())
          part = without_quotes(part);
      }
      if (axis.values.empty())
        throw UserError(place + ": " + axis.name() + " has no values." + remedy);
      refuse_split_triples(axis, trim(text.substr(colon + 1)), place);
      for (const auto &values : axis.values)
      {
        if (values.size() != axis.keys.size()
            || std::find(values.begin(), values.end(), "") != values.end())
          throw UserError(fmt::format(
              "{}: {} has the value '{}', where {} are needed, none of them empty.{}", place,
              axis.name(), joined(values, " + "), axis.keys.size(),
              axis.keys.size() > 1 ? remedy_of_joined(joined(values, " + "), axis.keys.size())
                                   : remedy));
        if (std::count(axis.values.begin(), axis.values.end(), values) > 1)
          throw UserError(place + ": " + axis.name() + " lists '" + joined(values, " + ")
                          + "' twice. Keep one."
                          + (find_unquoted(text, ';') == std::string::npos
                                 ? ""
                                 : " If the ';' belong to the values, put each value in double "
                                   "quotes: \"0; 0; t\" \"0; 0; 2*t\"."));
      }
      return axis;
    }
  } // namespace

  std::string
  StudyAxis::name() const
  {
    return joined(keys, " + ");
  }

  std::string
  StudyAxis::text(const unsigned int choice) const
  {
    return joined(values[choice], " + ");
  }

  std::vector<Assignment>
  parse_settings(const std::string &text, const std::string &place)
  {
    std::vector<Assignment> settings;
    std::set<std::string>   paths;
    require_closed_quotes(text, place);
    for (const std::string &part : split_unquoted(text, ';'))
      if (!part.empty())
      {
        settings.push_back(parse_assignment(part, place));
        refuse_foreign_signs(settings.back().value, place + ": " + settings.back().path());
        settings.back().value = without_quotes(settings.back().value);
        require_own_key(settings.back());
        if (!paths.insert(settings.back().path()).second)
          throw UserError(place + ": " + settings.back().path() + " is set twice. Keep one.");
      }
    return settings;
  }

  std::vector<StudyAxis>
  parse_axes(const std::string &text, const std::string &place)
  {
    std::vector<StudyAxis> axes;
    std::set<std::string>  keys;
    require_closed_quotes(text, place);
    for (const std::string &part : split_unquoted(text, '|'))
    {
      axes.push_back(parse_axis(part, place));
      for (const std::string &key : axes.back().keys)
      {
        require_own_key(parse_assignment(key + "=", place));
        if (!keys.insert(key).second)
          throw UserError(place + ": " + key + " is varied twice. Keep one axis.");
      }
    }
    return axes;
  }
} // namespace Exemplar
