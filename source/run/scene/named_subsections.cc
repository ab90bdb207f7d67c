// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/nearest_word.h>
#include <exemplar/prm/key_table.h>
#include <exemplar/run/scene/named_subsections.h>

#include <algorithm>
#include <set>

namespace Exemplar
{
  namespace
  {
    /// Sentences on which of `names` a misspelt subsection may mean; empty if none.
    std::string
    meant_name(const std::string              &name,
               const std::string              &section,
               const std::vector<std::string> &names)
    {
      for (const std::string &several : names) // such as 'left right', perhaps one name
      {
        const std::vector<std::string> words = split_trimmed(several, ' ');
        if (words.size() > 1 && std::find(words.begin(), words.end(), name) != words.end())
          return "Names are separated by commas: set Names = " + joined(words) + ".";
      }
      if (const std::string nearest = nearest_word(name, names); !nearest.empty())
        return "Did you mean " + section + "/" + nearest
               + "? Else add it there, or remove the subsection.";
      return "";
    }

    /// Remedy for a subsection that Names does not list.
    std::string
    remedy_of_name(const std::string              &name,
                   const std::string              &section,
                   const std::vector<std::string> &names)
    {
      const std::string meant = meant_name(name, section, names);
      return meant.empty() ? "Add it there, or remove the subsection." : meant;
    }
  } // namespace

  void
  check_names(const std::vector<std::string> &names, const std::string &section)
  {
    std::set<std::string> seen;
    for (const std::string &name : names)
    {
      if (!seen.insert(name).second)
        throw UserError(section + "/Names lists '" + name + "' twice. Names must differ.");
      if (name.empty() || name.find_first_of("/\";|") != std::string::npos)
        throw UserError(
            section + "/Names: '" + name + "' is no name. Use letters, digits, blanks, - and _"
            + (name.empty() ? "; between two commas there must be a name."
               : name.find_first_of(";|/") != std::string::npos ? ". Names are separated by commas."
                                                                : ", without quotes."));
    }
  }

  std::vector<std::string>
  drop_unlisted(std::vector<Assignment>        &named,
                const std::vector<Assignment>  &others,
                const std::vector<Assignment>  &overrides,
                const std::string              &section,
                const std::vector<std::string> &names,
                const std::string              &list)
  {
    const auto is_unlisted = [&](const Assignment &a)
    {
      return a.subsections.size() > 1 && a.subsections[0] == section
             && std::find(names.begin(), names.end(), a.subsections[1]) == names.end();
    };
    std::vector<std::string> unused_names; // listed names without a subsection
    for (const std::string &name : names)
      if (std::none_of(named.begin(), named.end(),
                       [&](const Assignment &a)
                       { return a.subsections[0] == section && a.subsections[1] == name; }))
        unused_names.push_back(name);
    const auto told = [&](const Assignment &a)
    {
      return a.place + ": subsection " + section + "/" + a.subsections[1] + " is not in " + section
             + "/" + list + " (there: " + (names.empty() ? "none" : joined(names)) + ")";
    };
    for (const Assignment &a : overrides)
      if (is_unlisted(a))
        throw UnknownKey(told(a) + ". " + remedy_of_name(a.subsections[1], section, names));
    const bool            is_forgotten = find_assignment(others, section + "/" + list) == nullptr;
    std::set<std::string> seen;
    std::vector<std::string> warnings;
    for (const Assignment &a : named)
    {
      if (!is_unlisted(a) || !seen.insert(a.subsections[1]).second)
        continue;
      if (const std::string meant = meant_name(a.subsections[1], section, unused_names);
          is_forgotten || !meant.empty())
        throw UnknownKey(told(a) + ". "
                         + (is_forgotten ? "Add it there, or remove the subsection." : meant));
      warnings.push_back(told(a) + ", so it is not used. Add it there, or remove the subsection.");
    }
    named.erase(std::remove_if(named.begin(), named.end(), is_unlisted), named.end());
    return warnings;
  }
} // namespace Exemplar
