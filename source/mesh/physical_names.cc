// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/nearest_word.h>
#include <exemplar/mesh/physical_names.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <vector>

namespace Exemplar
{
  namespace
  {
    /// A name without its quotes, if any.
    std::string
    unquoted(const std::string &text)
    {
      return text.size() > 1 && text.front() == '"' && text.back() == '"'
                 ? text.substr(1, text.size() - 2)
                 : text;
    }

    std::string
    suggestion(const MshFile &mesh, const int dimension, const std::string &wanted)
    {
      std::vector<std::string> names;
      for (const auto &[group, name] : mesh.physical_names)
        if (group.first == dimension)
          names.push_back(name);
      const std::string nearest = nearest_word(wanted, names);
      return nearest.empty() ? "" : "Did you mean " + in_quotes(nearest) + "? ";
    }

    std::string
    names_present(const MshFile &mesh, const int dimension)
    {
      std::string text;
      for (const auto &[group, name] : mesh.physical_names)
        if (group.first == dimension)
          text += (text.empty() ? "" : ", ") + in_quotes(name);
      return text.empty() ? "none" : text;
    }
  } // namespace

  std::optional<unsigned int>
  parse_id(const std::string &text, const std::string &key)
  {
    char        *end    = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    if (text.empty() || end != text.c_str() + text.size())
      return {};
    if (!(number >= 0. && number <= std::numeric_limits<int>::max())
        || number != std::floor(number))
      throw UserError(key
                      + ": an id is a whole number from 0 on, or a name of the mesh file (in "
                        "quotes, if it looks like a number), not "
                      + in_quotes(text) + ".");
    return static_cast<unsigned int>(number);
  }

  std::string
  remedy_of_geo(const MshFile &mesh)
  {
    return mesh.geo_walls
               ? " If the .geo has it: gmsh leaves out, without a word, a group of which "
                 "no surface or volume exists; look at the tags in its braces."
               : "";
  }

  unsigned int
  find_id(const MshFile &mesh, const int dimension, const std::string &text, const std::string &key)
  {
    if (const auto id = parse_id(text, key))
      return *id;
    const std::string  wanted = unquoted(text);
    std::set<unsigned> found;
    for (const auto &[group, name] : mesh.physical_names)
      if (group.first == dimension && name == wanted)
        found.insert(static_cast<unsigned int>(std::abs(group.second)));
    const std::string kind = dimension == 3   ? "Physical Volume"
                             : dimension == 2 ? "Physical Surface"
                                              : "Physical Point";
    if (found.empty()
        && (wanted.find(',') != std::string::npos
            || (wanted.find(' ') != std::string::npos
                && wanted.find_first_not_of("0123456789 ") == std::string::npos)))
      throw UserError(key + ": one " + kind + " is selected at a time, and none has the name "
                      + in_quotes(wanted)
                      + ". Give each a subsection of its own, or put all into one " + kind + ".");
    if (found.empty())
      throw UserError(key + ": the mesh has no " + kind + " of the name " + in_quotes(wanted)
                      + " (present: " + names_present(mesh, dimension) + "). "
                      + suggestion(mesh, dimension, wanted)
                      + "Give one that name, or its number here." + remedy_of_geo(mesh));
    if (found.size() > 1)
      throw UserError(key + ": several of the mesh's " + kind + "s have the name "
                      + in_quotes(wanted) + ". Give a number here.");
    return *found.begin();
  }
} // namespace Exemplar
