// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/mesh/mesh_joining.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>

namespace Exemplar
{
  namespace
  {
    /// The least power of ten, from 10 on, above a number.
    std::size_t
    power_of_ten_above(const std::size_t number)
    {
      std::size_t power = 10;
      while (power <= number)
        power *= 10;
      return power;
    }

    std::size_t
    greatest_node_number(const MshFile &file)
    {
      return file.node_numbers.empty()
                 ? 0
                 : *std::max_element(file.node_numbers.begin(), file.node_numbers.end());
    }

    /// What is added to the numbers of a file for each file before it.
    struct Strides
    {
      std::size_t nodes, elements, tags;
    };

    Strides
    strides_of(const std::vector<MshFile> &files)
    {
      std::size_t node = 0, element = 0, tag = 0;
      for (const MshFile &file : files)
      {
        node = std::max(node, greatest_node_number(file));
        for (const MshElement &e : file.elements)
        {
          element = std::max(element, e.number);
          for (const int one : { e.physical, e.elementary })
            tag = std::max(tag, static_cast<std::size_t>(std::abs(static_cast<long long>(one))));
        }
        for (const auto &[entity, tags] : file.further_groups)
          for (const int one : tags)
            tag = std::max(tag, static_cast<std::size_t>(std::abs(static_cast<long long>(one))));
      }
      return { power_of_ten_above(node), power_of_ten_above(element), power_of_ten_above(tag) };
    }

    /// A tag of the k-th file, with its sign.
    int
    moved_tag(const int tag, const std::size_t k, const Strides &strides)
    {
      return tag < 0 ? tag - static_cast<int>(k * strides.tags)
                     : tag + static_cast<int>(k * strides.tags);
    }

    unsigned int
    dimension_of(const MshElement &element)
    {
      return find_msh_element_kind(element.type)->dimension;
    }

    /// Names of the groups of a file in the joined mesh, by dimension and its own tag.
    std::map<std::pair<int, int>, std::string>
    names_of_groups(const MshFile &file, const std::string &name)
    {
      std::set<std::pair<int, int>> groups;
      for (const MshElement &element : file.elements)
        if (const auto dimension = static_cast<int>(dimension_of(element));
            element.physical != 0 || dimension == 3)
          groups.emplace(dimension, element.physical);
      for (const auto &[entity, tags] : file.further_groups)
        for (const int tag : tags)
          groups.emplace(entity.first, tag);
      for (const auto &[group, of_group] : file.physical_names)
        groups.insert(group);
      const auto n_regions = std::count_if(groups.begin(), groups.end(),
                                           [](const auto &group) { return group.first == 3; });
      std::map<std::pair<int, int>, std::string> names;
      for (const auto &group : groups)
      {
        const auto named = file.physical_names.find(group);
        names[group]     = group.first == 3 && n_regions == 1
                               ? name
                               : name + " "
                                 + (named != file.physical_names.end()
                                            ? named->second
                                            : std::to_string(std::abs(group.second)));
      }
      return names;
    }

    dealii::Point<3>
    placed_point(const dealii::Point<3> &x, const JoinedFile &file)
    {
      return file.scale * x + file.displacement;
    }

    void
    append(MshFile &joined, MshFile file, const PlacedFile &placed, const Strides &strides)
    {
      const std::size_t k = joined.files.size(), first = joined.nodes.size();
      JoinedFile        part{ placed.name,  first, file.nodes.size(), joined.elements.size(),
                       placed.scale, {} };
      for (unsigned int c = 0; c < 3; ++c)
        part.displacement[c] = placed.displacement[c];
      for (std::size_t i = 0; i < file.nodes.size(); ++i)
      {
        joined.node_numbers.push_back(file.node_numbers[i] + k * strides.nodes);
        joined.nodes.push_back(placed_point(file.nodes[i], part));
      }
      for (const auto &[group, name] : names_of_groups(file, placed.name))
        joined.physical_names[{ group.first, moved_tag(group.second, k, strides) }] = name;
      for (const auto &[entity, tags] : file.further_groups)
        for (const int tag : tags)
          joined.further_groups[{ entity.first, moved_tag(entity.second, k, strides) }].push_back(
              moved_tag(tag, k, strides));
      for (MshElement &element : file.elements)
      {
        element.number += k * strides.elements;
        if (element.physical != 0 || dimension_of(element) == 3)
          element.physical = moved_tag(element.physical, k, strides);
        element.elementary = moved_tag(element.elementary, k, strides);
        for (std::size_t &node : element.nodes)
          node += first;
        joined.elements.push_back(std::move(element));
      }
      if (!file.note.empty())
        joined.note += (joined.note.empty() ? "" : " ") + placed.name + ": " + file.note;
      joined.files.push_back(std::move(part));
    }

    std::vector<std::vector<std::size_t>>
    tetrahedra_nodes(const std::vector<MshElement> &elements)
    {
      std::vector<std::vector<std::size_t>> nodes;
      for (const MshElement &element : elements)
        if (element.type == MshElementType::tetrahedron)
          nodes.push_back(element.nodes);
      return nodes;
    }

    /// Whether the pose has the nodes' numbers and the tetrahedra of the k-th file.
    bool
    is_pose_of(const MshFile &pose, const MshFile &joined, const std::size_t k)
    {
      const JoinedFile &file = joined.files[k];
      if (pose.nodes.size() != file.n_nodes)
        return false;
      const std::size_t moved = joined.node_numbers[file.first_node] - pose.node_numbers[0];
      for (std::size_t i = 0; i < file.n_nodes; ++i)
        if (pose.node_numbers[i] + moved != joined.node_numbers[file.first_node + i])
          return false;
      const auto end   = k + 1 < joined.files.size()
                             ? joined.elements.begin()
                                 + static_cast<std::ptrdiff_t>(joined.files[k + 1].first_element)
                             : joined.elements.end();
      auto       nodes = tetrahedra_nodes(
                { joined.elements.begin() + static_cast<std::ptrdiff_t>(file.first_element), end });
      for (auto &tetrahedron : nodes)
        for (std::size_t &node : tetrahedron)
          node -= file.first_node;
      return nodes == tetrahedra_nodes(pose.elements);
    }
  } // namespace

  MshFile
  join_meshes(std::vector<MshFile> files, const std::vector<PlacedFile> &placed)
  {
    const Strides     strides = strides_of(files);
    constexpr auto    largest = static_cast<std::size_t>(std::numeric_limits<int>::max());
    const std::size_t n       = files.size();
    if (std::max({ strides.nodes, strides.elements, strides.tags }) > largest / n)
      throw UserError(
          fmt::format("Mesh/Files: numbers of nodes, elements or tags are as large as {}, so that "
                      "those of {} files do not "
                      "fit into a .msh. Number the nodes, elements and groups of the files from 1.",
                      std::max({ strides.nodes, strides.elements, strides.tags }) / 10, n));
    for (const PlacedFile &file : placed)
      if (!(file.scale > 0.))
        throw UserError(
            fmt::format("Mesh/{}/Scale: must be positive, found {}. Leave it at 1 if the "
                        "file is in the unit of the others.",
                        file.name, file.scale));
    MshFile joined;
    for (std::size_t k = 0; k < n; ++k)
      append(joined, std::move(files[k]), placed[k], strides);
    return joined;
  }

  std::optional<std::vector<dealii::Point<3>>>
  pose_of_one_file(const MshFile &pose, const MshFile &joined, const std::string &prefix)
  {
    std::vector<const JoinedFile *> found;
    for (std::size_t k = 0; k < joined.files.size(); ++k)
      if (is_pose_of(pose, joined, k))
        found.push_back(&joined.files[k]);
    if (found.empty() || pose.nodes.size() == joined.nodes.size())
      return {};
    if (found.size() > 1)
      throw UserError(prefix + "it fits " + in_quotes(found[0]->name) + " and "
                      + in_quotes(found[1]->name)
                      + " alike. Give a pose of all files, such as a final.msh of a scene with the "
                        "same Mesh/Files.");
    std::vector<dealii::Point<3>> places = joined.nodes;
    for (std::size_t i = 0; i < pose.nodes.size(); ++i)
      places[found[0]->first_node + i] = placed_point(pose.nodes[i], *found[0]);
    return places;
  }
} // namespace Exemplar
