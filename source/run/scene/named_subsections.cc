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
    /// What to say of a subsection that Names does not list.
    std::string
    remedy_of_name(const std::string              &name,
                   const std::string              &section,
                   const std::vector<std::string> &names)
    {
      for (const std::string &several : names) // such as 'left right', which might be one name
      {
        const std::vector<std::string> words = split_trimmed(several, ' ');
        if (words.size() > 1 && std::find(words.begin(), words.end(), name) != words.end())
          return "Names are separated by commas: set Names = " + joined(words) + ".";
      }
      if (const std::string nearest = nearest_word(name, names); !nearest.empty())
        return "Did you mean " + section + "/" + nearest
               + "? Else add it there, or remove the subsection.";
      return "Add it there, or remove the subsection.";
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

  void
  check_listed(const std::vector<Assignment>  &assignments,
               const std::string              &section,
               const std::vector<std::string> &names)
  {
    for (const Assignment &a : assignments)
      if (a.subsections[0] == section
          && std::find(names.begin(), names.end(), a.subsections[1]) == names.end())
        throw UnknownKey(a.place + ": subsection " + section + "/" + a.subsections[1]
                         + " is not in " + section
                         + "/Names (there: " + (names.empty() ? "none" : joined(names)) + "). "
                         + remedy_of_name(a.subsections[1], section, names));
  }
} // namespace Exemplar
