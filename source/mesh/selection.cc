// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/mesh/physical_names.h>
#include <exemplar/mesh/selection.h>
#include <exemplar/mesh/selection_words.h>

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <set>
#include <sstream>
#include <utility>

namespace Exemplar
{
  namespace
  {
    constexpr int point = 0, surface = 2, volume = 3; // dimensions of sets, boundaries and regions

    /// The id of a selection by id or name.
    unsigned int
    id_in(const SelectionWords &words,
          const int             dimension,
          const Mesh           &mesh,
          const std::string    &key)
    {
      if (words.rest.empty())
        throw UserError(key + " = '" + words.kind + "' does not say which " + words.kind
                        + ". Write an id or a name behind it, such as '" + words.kind + " 1'.");
      return find_id(mesh.get_contents(), dimension, words.rest,
                     key + " = '" + words.kind + " " + words.rest + "'");
    }

    std::string
    list(const std::set<unsigned int> &ids)
    {
      std::string text;
      for (const unsigned int id : ids)
        text += fmt::format("{}{}", text.empty() ? "" : ", ", id);
      return text;
    }

    template <typename Predicate>
    std::vector<unsigned int>
    nodes_where(const Mesh &mesh, const Predicate &selected)
    {
      std::vector<unsigned int> nodes;
      for (unsigned int node = 0; node < mesh.n_nodes(); ++node)
        if (selected(mesh.get_nodes()[node]))
          nodes.push_back(node);
      return nodes;
    }

    std::vector<unsigned int>
    nodes_in_box(const Mesh &mesh, const std::vector<double> &box)
    {
      return nodes_where(mesh,
                         [&](const dealii::Point<3> &x)
                         {
                           bool inside = true;
                           for (unsigned int d = 0; d < 3; ++d)
                             inside = inside && x[d] >= std::min(box[d], box[d + 3])
                                      && x[d] <= std::max(box[d], box[d + 3]);
                           return inside;
                         });
    }

    std::vector<unsigned int>
    nodes_in_sphere(const Mesh &mesh, const std::vector<double> &sphere)
    {
      const dealii::Point<3> center(sphere[0], sphere[1], sphere[2]);
      return nodes_where(mesh, [&](const dealii::Point<3> &x)
                         { return x.distance(center) <= sphere[3]; });
    }

    std::vector<unsigned int>
    nodes_of_region(const Mesh &mesh, const unsigned int id, const std::string &key)
    {
      const auto            &ids = mesh.get_material_ids();
      std::set<unsigned int> nodes;
      for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
        if (ids[cell] == id)
          nodes.insert(mesh.corners(cell).begin(), mesh.corners(cell).end());
      const unsigned int type
          = mesh.is_shell() ? MshElementType::triangle : MshElementType::tetrahedron;
      if (const MshFile &contents = mesh.get_contents(); !contents.further_groups.empty())
        for (const MshElement &element : contents.elements)
          if (element.type == type && is_in_group(contents, element, id))
            nodes.insert(element.nodes.begin(), element.nodes.end());
      if (nodes.empty())
        throw UserError(fmt::format("{}: region {} has no cells in {} (present: {}). Give a "
                                    "Physical Volume that tag, or change {}.",
                                    key, id, mesh.get_name(),
                                    list(std::set<unsigned int>(ids.begin(), ids.end())), key));
      return { nodes.begin(), nodes.end() };
    }

    std::vector<unsigned int>
    nodes_of_set(const Mesh &mesh, const unsigned int id, const std::string &key)
    {
      std::set<unsigned int> nodes;
      for (const MshElement &element : mesh.get_contents().elements)
        if (element.type == MshElementType::point && is_in_group(mesh.get_contents(), element, id))
          nodes.insert(static_cast<unsigned int>(element.nodes[0]));
      if (nodes.empty())
        throw UserError(fmt::format("{}: the set {} has no nodes in {}. Sets are the Physical "
                                    "Points of a .msh and the node sets "
                                    "(*NSET) of an .inp.",
                                    key, id, mesh.get_name()));
      return { nodes.begin(), nodes.end() };
    }

    std::vector<unsigned int>
    nodes_of_faces(const Mesh                      &mesh,
                   const std::vector<BoundaryFace> &faces,
                   const unsigned int               id,
                   const std::string               &key)
    {
      std::set<unsigned int> nodes, present;
      for (const BoundaryFace &face : faces)
        nodes.insert(face.nodes.begin(), face.nodes.end());
      for (const std::vector<BoundaryFace> *const some :
           { &mesh.get_boundary_faces(), &mesh.get_further_faces() })
        for (const BoundaryFace &face : *some)
          present.insert(face.boundary_id);
      if (nodes.empty())
        throw UserError(fmt::format(
            "{}: boundary id {} has no faces in {} (present: {}{}", key, id, mesh.get_name(),
            list(present),
            mesh.get_contents().elements.size() == mesh.n_cells()
                ? "), which has no triangles. Select by box, sphere or region; boundary ids come "
                  "from the Physical Surfaces of a mesh file."
                : fmt::format("). Give a Physical Surface the tag {}, or change {}.{}", id, key,
                              remedy_of_geo(mesh.get_contents()))));
      return { nodes.begin(), nodes.end() };
    }

    std::vector<unsigned int>
    named_nodes(const Mesh        &mesh,
                const NamedNodes  &named,
                const std::string &name,
                const std::string &key)
    {
      const auto found = named.find(name);
      if (found == named.end())
        throw UserError(key + ": there are no nodes '" + name
                        + "' among the inputs. Hand them in by this name, or read them from a "
                          "file.");
      const std::set<unsigned int> nodes(found->second.begin(), found->second.end());
      if (!nodes.empty() && *nodes.rbegin() >= mesh.n_nodes())
        throw UserError(fmt::format("{}: the nodes '{}' have the index {}, but the mesh has "
                                    "{} nodes. They are counted from 0.",
                                    key, name, *nodes.rbegin(), mesh.n_nodes()));
      return { nodes.begin(), nodes.end() };
    }

    /// Throws UserError for a missing selection; `key` is SECTION/NAME/Select.
    [[noreturn]] void
    fail_unset(const std::string &key)
    {
      const std::size_t first = key.find('/'), last = key.rfind('/');
      const std::string name = key.substr(first + 1, last - first - 1);
      throw UserError(
          key + " is not set. Within subsection " + key.substr(0, first) + ", subsection " + name
          + " needs a line 'set Select = boundary 1'; if it is not there, write " + "'subsection "
          + name + "' before it and 'end' behind it. Allowed: " + selection_forms + ".");
    }

    [[noreturn]] void
    fail_empty(const Mesh &mesh, const std::string &key, const std::string &text)
    {
      dealii::Point<3> low = mesh.get_nodes()[0], high = low;
      for (const dealii::Point<3> &x : mesh.get_nodes())
        for (unsigned int d = 0; d < 3; ++d)
        {
          low[d]  = std::min(low[d], x[d]);
          high[d] = std::max(high[d], x[d]);
        }
      std::ostringstream message;
      const std::string  doubt = Selection{ text }.doubt();
      message << key << " = '" << text << "' selects no node. The mesh " << mesh.get_name()
              << " lies in the box " << low << "  " << high
              << " [m]; enlarge or move the selection." << (doubt.empty() ? "" : " ") << doubt;
      throw UserError(message.str());
    }
  } // namespace

  std::vector<BoundaryFace>
  Selection::faces(const Mesh &mesh, const std::string &key) const
  {
    const unsigned int        id = id_in(split_selection(text), surface, mesh, key);
    std::vector<BoundaryFace> selected;
    for (const std::vector<BoundaryFace> *const some :
         { &mesh.get_boundary_faces(), &mesh.get_further_faces() })
      for (const BoundaryFace &face : *some)
        if (face.boundary_id == id)
          selected.push_back(face);
    return selected;
  }

  std::vector<unsigned int>
  Selection::nodes(const Mesh &mesh, const std::string &key, const NamedNodes &named) const
  {
    const auto chosen_before = named.find(text);
    return chosen_before != named.end() ? chosen_before->second : choose(mesh, key, named);
  }

  std::vector<unsigned int>
  Selection::choose(const Mesh &mesh, const std::string &key, const NamedNodes &named) const
  {
    const SelectionWords      words = split_selection(text);
    std::vector<unsigned int> nodes;
    if (words.kind == "box")
      nodes = nodes_in_box(mesh, selection_numbers(words, 6, key));
    else if (words.kind == "sphere")
      nodes = nodes_in_sphere(mesh, selection_numbers(words, 4, key));
    else if (words.kind == "region")
      nodes = nodes_of_region(mesh, id_in(words, volume, mesh, key), key);
    else if (words.kind == "set")
      nodes = nodes_of_set(mesh, id_in(words, point, mesh, key), key);
    else if (words.kind == "nodes")
      nodes = named_nodes(mesh, named, words.rest, key);
    else if (is_of_surface())
      nodes = named_nodes(mesh, named, text, key);
    else if (words.kind == "boundary")
      nodes = nodes_of_faces(mesh, faces(mesh, key), id_in(words, surface, mesh, key), key);
    else if (words.kind.empty())
      fail_unset(key);
    else
      throw UserError(key + " = '" + text + "' is not understood." + remedy_of_selection(words)
                      + " Allowed: " + selection_forms + ".");

    if (nodes.empty())
      fail_empty(mesh, key, text);
    return nodes;
  }
  std::string
  Selection::doubt() const
  {
    std::istringstream         in(text);
    std::string                kind, more;
    std::array<std::string, 6> word;
    in >> kind;
    for (std::string &one : word)
      in >> one;
    const auto are_in_order = [&](const std::size_t first, const std::size_t second)
    { return parse_number(word[first]) <= parse_number(word[second]); };
    const bool are_corners = are_in_order(0, 3) && are_in_order(1, 4) && are_in_order(2, 5);
    const bool are_ranges  = are_in_order(0, 1) && are_in_order(2, 3) && are_in_order(4, 5);
    if (kind != "box" || !in || in >> more || are_corners || !are_ranges)
      return "";
    const auto box = [&](const std::array<std::size_t, 6> &order)
    {
      std::string result = "'box";
      for (const std::size_t i : order)
        result += " " + word[i];
      return result + "'";
    };
    std::array<std::size_t, 6> rising{ { 0, 1, 2, 3, 4, 5 } };
    for (std::size_t c = 0; c < 3; ++c)
      if (!are_in_order(c, c + 3))
        std::swap(rising[c], rising[c + 3]);
    const std::string ranges = box({ { 0, 2, 4, 1, 3, 5 } }), corners = box(rising);
    return ranges == corners ? ""
                             : "A box has two corners, x0 y0 z0 and x1 y1 z1. Did you mean "
                                   + ranges + "? If not, write " + corners + ".";
  }
} // namespace Exemplar
