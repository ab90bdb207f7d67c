// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/words.h>
#include <exemplar/mesh/mesh_checks.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <set>
#include <tuple>

namespace Exemplar
{
  namespace
  {
    constexpr double flat_tolerance = 1e-12;
    constexpr double largest_place  = 1e50; ///< [m]; energies grow as its fifth power

    void
    check_element_kinds(const MshFile &contents, const std::string &name)
    {
      std::vector<std::size_t> refused;
      unsigned int             refused_type = 0;
      for (const MshElement &element : contents.elements)
      {
        const MshElementKind *const kind   = find_msh_element_kind(element.type);
        const bool                  usable = element.type == MshElementType::tetrahedron
                            || element.type == MshElementType::triangle
                            || (kind != nullptr && kind->dimension < 2);
        if (usable)
          continue;
        if (refused.empty())
          refused_type = element.type;
        refused.push_back(element.number);
      }
      if (refused.empty())
        return;
      const MshElementKind *const kind = find_msh_element_kind(refused_type);
      throw UserError(fmt::format(
          "{}: element {} is a {}; only 4-node tetrahedra and 3-node triangles are supported ({} "
          "of other kinds: {}). Mesh with tetrahedra of first order: Mesh.ElementOrder = 1, no "
          "Recombine, no Transfinite Volume with Recombine.",
          name, refused.front(), kind != nullptr ? kind->name : "element of unknown type",
          counted(refused.size(), "element"), list_numbers(refused)));
    }

    /// Refuse a mesh in which some coordinate is the same at all nodes.
    void
    refuse_flat_mesh(const MshFile &contents, const std::string &name)
    {
      for (unsigned int d = 0; d < 3; ++d)
      {
        const double first = contents.nodes.front()[d];
        if (std::all_of(contents.nodes.begin(), contents.nodes.end(),
                        [&](const dealii::Point<3> &node) { return node[d] == first; }))
          throw UserError(name + ": the mesh is flat: " + "xyz"[d] + " is " + short_text(first)
                          + " at all nodes. Only bodies in space have a volume: look at what wrote "
                            "the coordinates, or mesh an extruded body.");
      }
    }

    double
    squared_longest_edge(const std::array<dealii::Point<3>, 4> &corners)
    {
      double longest = 0.;
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int b = a + 1; b < 4; ++b)
          longest = std::max(longest, corners[a].distance_square(corners[b]));
      return longest;
    }

    double
    signed_volume(const std::array<dealii::Point<3>, 4> &corners)
    {
      const auto a = corners[1] - corners[0];
      const auto b = corners[2] - corners[0];
      const auto c = corners[3] - corners[0];
      return (a * dealii::cross_product_3d(b, c)) / 6.;
    }
  } // namespace

  std::string
  list_numbers(const std::vector<std::size_t> &numbers)
  {
    constexpr std::size_t n_listed = 5;
    std::string           text;
    for (std::size_t i = 0; i < std::min(n_listed, numbers.size()); ++i)
      text += fmt::format("{}{}", i == 0 ? "" : ", ", numbers[i]);
    if (numbers.size() > n_listed)
      text += fmt::format(" and {} more", numbers.size() - n_listed);
    return text;
  }

  Tetrahedra
  extract_tetrahedra(const MshFile &contents, const std::string &name)
  {
    check_element_kinds(contents, name);
    Tetrahedra tetrahedra;
    tetrahedra.nodes.reserve(contents.elements.size());
    tetrahedra.material_ids.reserve(contents.elements.size());
    for (const MshElement &element : contents.elements)
      if (element.type == MshElementType::tetrahedron)
      {
        std::array<unsigned int, 4> nodes;
        for (unsigned int v = 0; v < 4; ++v)
          nodes[v] = static_cast<unsigned int>(element.nodes[v]);
        tetrahedra.nodes.push_back(nodes);
        tetrahedra.material_ids.push_back(static_cast<unsigned int>(std::abs(element.physical)));
        tetrahedra.element_numbers.push_back(element.number);
      }
    if (tetrahedra.nodes.empty() && contents.geo_walls)
      throw UserError(name
                      + ": has no tetrahedra. It needs a Volume: Extrude a surface, or close a "
                        "Surface Loop around one. If it has Physical groups, it needs a Physical "
                        "Volume, too: gmsh keeps only what is in them.");
    if (tetrahedra.nodes.empty())
      throw UserError(name
                      + ": has no tetrahedra. Mesh in three dimensions (gmsh -3) and, if "
                        "there are Physical groups, give the volume one as well: gmsh saves "
                        "only elements in Physical groups.");
    return tetrahedra;
  }

  std::vector<std::size_t>
  orient_tetrahedra(const MshFile &contents, const std::string &name, Tetrahedra &tetrahedra)
  {
    std::vector<std::size_t> flat;
    std::vector<std::size_t> swapped;
    for (std::size_t cell = 0; cell < tetrahedra.nodes.size(); ++cell)
    {
      auto                           &nodes = tetrahedra.nodes[cell];
      std::array<dealii::Point<3>, 4> corners;
      for (unsigned int v = 0; v < 4; ++v)
        corners[v] = contents.nodes[nodes[v]];
      const double volume  = signed_volume(corners);
      const double longest = std::sqrt(squared_longest_edge(corners));
      // Written so that an overflow to NaN is refused, too.
      if (!(std::abs(volume) > flat_tolerance * longest * longest * longest))
        flat.push_back(tetrahedra.element_numbers[cell]);
      else if (volume < 0.)
      {
        std::swap(nodes[2], nodes[3]);
        swapped.push_back(tetrahedra.element_numbers[cell]);
      }
    }
    if (!flat.empty() && flat.size() == tetrahedra.nodes.size())
      refuse_flat_mesh(contents, name);
    if (!flat.empty())
      throw UserError(name + ": " + counted(flat.size(), "tetrahedron")
                      + " without volume (at "
                        "most 1e-12 of the cube of the longest edge): element "
                      + list_numbers(flat)
                      + ". Remesh, e.g. with Mesh.OptimizeNetgen = 1, or coarser.");
    return swapped;
  }

  void
  check_places(const std::vector<dealii::Point<3>> &nodes,
               const MshFile                       &contents,
               const std::string                   &name)
  {
    for (std::size_t node = 0; node < nodes.size(); ++node)
      for (unsigned int d = 0; d < 3; ++d)
        if (!(std::abs(nodes[node][d]) < largest_place))
          throw UserError(fmt::format("{}: {} lies at a coordinate that is no finite number, or "
                                      "larger than 1e50 m. Look at the file, and at Mesh/Scale.",
                                      name,
                                      node < contents.node_numbers.size()
                                          ? fmt::format("node {}", contents.node_numbers[node])
                                          : "a node in the middle of an edge"));
  }

  void
  scale_nodes(MshFile &contents, const std::string &name, const double scale)
  {
    if (!(scale > 0.))
      throw UserError(fmt::format(
          "Mesh/Scale: must be positive, found {:f}. Leave it at 1 if the mesh is in metres.",
          scale));
    for (auto &node : contents.nodes)
      node *= scale;
    check_places(contents.nodes, contents, name);
  }

  void
  check_orphan_nodes(const MshFile &contents, const std::string &name, const Tetrahedra &tetrahedra)
  {
    std::vector<bool> used(contents.nodes.size(), false);
    for (const auto &nodes : tetrahedra.nodes)
      for (const unsigned int node : nodes)
        used[node] = true;
    std::vector<std::size_t> orphans;
    for (std::size_t node = 0; node < used.size(); ++node)
      if (!used[node])
        orphans.push_back(contents.node_numbers[node]);
    if (!orphans.empty())
      throw UserError(name + ": " + counted(orphans.size(), "node") + " in no tetrahedron: node "
                      + list_numbers(orphans)
                      + ". Remove construction points and surfaces that bound no volume from the "
                        "geometry, put every volume in a Physical Volume, and save the mesh anew.");
  }

  std::vector<CellFace>
  sorted_faces(const Tetrahedra &tetrahedra)
  {
    const auto for_each_face = [&](const auto &function)
    {
      for (unsigned int cell = 0; cell < tetrahedra.nodes.size(); ++cell)
      {
        std::array<unsigned int, 4> nodes = tetrahedra.nodes[cell];
        std::sort(nodes.begin(), nodes.end());
        function(CellFace{ { { nodes[1], nodes[2], nodes[3] } }, cell, nodes[0] });
        function(CellFace{ { { nodes[0], nodes[2], nodes[3] } }, cell, nodes[1] });
        function(CellFace{ { { nodes[0], nodes[1], nodes[3] } }, cell, nodes[2] });
        function(CellFace{ { { nodes[0], nodes[1], nodes[2] } }, cell, nodes[3] });
      }
    };
    // by least node, as there are few faces at a node: a fifth of the time of sorting them at once
    std::vector<std::size_t> end;
    for_each_face(
        [&](const CellFace &face)
        {
          if (face.nodes[0] + 1 >= end.size())
            end.resize(face.nodes[0] + 2, 0);
          ++end[face.nodes[0] + 1];
        });
    std::partial_sum(end.begin(), end.end(), end.begin());
    std::vector<CellFace> faces(4 * tetrahedra.nodes.size());
    for_each_face([&](const CellFace &face) { faces[end[face.nodes[0]]++] = face; });
    for (std::size_t node = 0, begin = 0; node < end.size(); begin = end[node++])
      std::sort(faces.begin() + static_cast<std::ptrdiff_t>(begin),
                faces.begin() + static_cast<std::ptrdiff_t>(end[node]),
                [](const CellFace &a, const CellFace &b) {
                  return std::tie(a.nodes, a.opposite, a.cell)
                         < std::tie(b.nodes, b.opposite, b.cell);
                });
    return faces;
  }

  void
  check_faces(const MshFile               &contents,
              const std::string           &name,
              const Tetrahedra            &tetrahedra,
              const std::vector<CellFace> &faces)
  {
    const auto &numbers = tetrahedra.element_numbers;
    for (std::size_t i = 1; i < faces.size(); ++i)
      if (faces[i].nodes == faces[i - 1].nodes && faces[i].opposite == faces[i - 1].opposite)
        throw UserError(fmt::format(
            "{}: tetrahedra {} and {} have the same nodes. Mesh every volume once, and put it in "
            "one Physical Volume only: MSH 2.2 repeats the elements for each.",
            name, numbers[faces[i - 1].cell], numbers[faces[i].cell]));

    for (std::size_t begin = 0, end = 0; begin < faces.size(); begin = end)
    {
      for (end = begin; end < faces.size() && faces[end].nodes == faces[begin].nodes;)
        ++end;
      if (end - begin <= 2)
        continue;
      std::vector<std::size_t> cells, corners;
      for (std::size_t i = begin; i < end; ++i)
        cells.push_back(numbers[faces[i].cell]);
      for (const unsigned int node : faces[begin].nodes)
        corners.push_back(contents.node_numbers[node]);
      throw UserError(name + ": the face with the nodes " + list_numbers(corners)
                      + " belongs to more than two tetrahedra: element " + list_numbers(cells)
                      + ". Volumes overlap: remove one, or join them in the geometry "
                        "(BooleanUnion, BooleanFragments).");
    }
  }

  void
  check_overlaps(const MshFile                  &contents,
                 const std::string              &name,
                 const Tetrahedra               &tetrahedra,
                 const std::vector<CellFace>    &faces,
                 const std::vector<std::size_t> &swapped)
  {
    const auto volume = [&](const CellFace &face)
    {
      const auto &nodes = contents.nodes;
      return signed_volume({ { nodes[face.nodes[0]], nodes[face.nodes[1]], nodes[face.nodes[2]],
                               nodes[face.opposite] } });
    };
    std::set<std::size_t> overlapping; // their element numbers
    for (std::size_t i = 1; i < faces.size(); ++i)
      if (faces[i].nodes == faces[i - 1].nodes
          && (volume(faces[i]) > 0.) == (volume(faces[i - 1]) > 0.))
        for (const std::size_t j : { i - 1, i })
          overlapping.insert(tetrahedra.element_numbers[faces[j].cell]);
    if (overlapping.empty())
      return;
    // if valid cells have the same order of nodes in the file, it tells which cells are inverted
    const std::set<std::size_t> negative(swapped.begin(), swapped.end());
    const bool                  is_mirrored = 2 * negative.size() > tetrahedra.nodes.size();
    std::vector<std::size_t>    inverted;
    for (const std::size_t number : overlapping)
      if ((negative.count(number) > 0) != is_mirrored)
        inverted.push_back(number);
    if (inverted.empty())
      inverted.assign(overlapping.begin(), overlapping.end());
    throw UserError(
        fmt::format("{}: {} of {} tetrahedra are inside out and overlap their neighbours: element "
                    "{}. A rest pose needs cells of positive volume: remesh its surface, or take "
                    "another pose for the mesh and this one as an example.",
                    name, inverted.size(), tetrahedra.nodes.size(), list_numbers(inverted)));
  }
} // namespace Exemplar
