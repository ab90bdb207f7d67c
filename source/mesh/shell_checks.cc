// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/mesh_arrays.h>
#include <exemplar/mesh/mesh_checks.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace Exemplar
{
  bool
  has_area(const dealii::Point<3> &a, const dealii::Point<3> &b, const dealii::Point<3> &c)
  {
    constexpr double thin = 1e-10; // twice the area over the square of the longest edge
    const auto       ab = b - a, ac = c - a;
    const double longest = std::max({ ab.norm_square(), ac.norm_square(), b.distance_square(c) });
    return dealii::cross_product_3d(ab, ac).norm() > thin * longest;
  }

  namespace
  {
    /// An edge of a triangle.
    struct TriangleEdge
    {
      unsigned int low, high; ///< its nodes
      unsigned int triangle;
      bool         is_ascending; ///< whether the triangle goes from `low` to `high`
    };

    void
    extract_triangles(const MshFile &contents, const std::string &name, MeshArrays &mesh)
    {
      for (const MshElement &element : contents.elements)
      {
        const MshElementKind *const kind = find_msh_element_kind(element.type);
        if (element.type == MshElementType::triangle)
        {
          mesh.triangles.push_back({ { static_cast<unsigned int>(element.nodes[0]),
                                       static_cast<unsigned int>(element.nodes[1]),
                                       static_cast<unsigned int>(element.nodes[2]) } });
          mesh.material_ids.push_back(static_cast<unsigned int>(std::abs(element.physical)));
          mesh.element_numbers.push_back(element.number);
        }
        else if (kind == nullptr || kind->dimension > 1)
          throw UserError(fmt::format(
              "{}: element {} is a {}, but Mesh/Kind = shell takes 3-node triangles. Mesh the "
              "surface alone (gmsh -2, Mesh.ElementOrder = 1, no Recombine), or set Mesh/Kind = "
              "solid. Sheets and solids in one scene are not supported.",
              name, element.number, kind != nullptr ? kind->name : "element of unknown type"));
      }
      if (mesh.triangles.empty())
        throw UserError(name
                        + ": has no triangles, of which Mesh/Kind = shell makes a body. Give a "
                          "surface, or a .msh of triangles (gmsh -2).");
    }

    void
    refuse_thin_triangles(const MshFile &contents, const std::string &name, const MeshArrays &mesh)
    {
      std::vector<std::size_t> thin;
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      {
        const auto &[a, b, c] = mesh.triangles[t];
        if (!has_area(contents.nodes[a], contents.nodes[b], contents.nodes[c]))
          thin.push_back(mesh.element_numbers[t]);
      }
      if (!thin.empty())
        throw UserError(fmt::format(
            "{}: {} of {} triangles have no area: element {}. Remove them, or mesh the surface "
            "anew.",
            name, thin.size(), mesh.triangles.size(), list_numbers(thin)));
    }

    void
    refuse_lonely_nodes(const MshFile &contents, const std::string &name, const MeshArrays &mesh)
    {
      std::vector<bool> used(contents.nodes.size(), false);
      for (const auto &nodes : mesh.triangles)
        for (const unsigned int node : nodes)
          used[node] = true;
      std::vector<std::size_t> lonely;
      for (std::size_t node = 0; node < used.size(); ++node)
        if (!used[node])
          lonely.push_back(contents.node_numbers[node]);
      if (!lonely.empty())
        throw UserError(fmt::format(
            "{}: {} of {} nodes are in no triangle: node {}. Remove them from the file.", name,
            lonely.size(), used.size(), list_numbers(lonely)));
    }

    /// All edges of all triangles, sorted by their nodes.
    std::vector<TriangleEdge>
    sorted_edges(const std::vector<std::array<unsigned int, 3>> &triangles)
    {
      std::vector<TriangleEdge> edges;
      edges.reserve(3 * triangles.size());
      for (unsigned int t = 0; t < triangles.size(); ++t)
        for (unsigned int v = 0; v < 3; ++v)
        {
          const unsigned int a = triangles[t][v], b = triangles[t][(v + 1) % 3];
          edges.push_back({ std::min(a, b), std::max(a, b), t, a < b });
        }
      std::sort(edges.begin(), edges.end(),
                [](const TriangleEdge &a, const TriangleEdge &b) {
                  return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
                });
      return edges;
    }

    /// Refuse edges of three triangles, and neighbours that are turned differently. `pair(a, b)` is called for neighbours.
    template <typename Pair>
    void
    for_each_neighbours(const MshFile                   &contents,
                        const std::string               &name,
                        const MeshArrays                &mesh,
                        const std::vector<TriangleEdge> &edges,
                        const Pair                      &pair)
    {
      for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end)
      {
        std::vector<std::size_t> here;
        for (end = begin; end < edges.size() && edges[end].low == edges[begin].low
                          && edges[end].high == edges[begin].high;
             ++end)
          here.push_back(mesh.element_numbers[edges[end].triangle]);
        if (here.size() == 1)
          continue;
        const std::size_t low  = contents.node_numbers[edges[begin].low],
                          high = contents.node_numbers[edges[begin].high];
        if (here.size() > 2)
          throw UserError(fmt::format("{}: the edge between nodes {} and {} belongs to {} "
                                      "triangles: element {}. A shell may have two at an "
                                      "edge, or one at its border: cut the sheets apart there.",
                                      name, low, high, here.size(), list_numbers(here)));
        if (edges[begin].is_ascending == edges[begin + 1].is_ascending)
          throw UserError(fmt::format("{}: the triangles at the edge between nodes {} and {} are "
                                      "turned differently: element {}. Their normals "
                                      "must point to one side of the shell: recalculate them "
                                      "(Blender: Mesh > Normals > Recalculate Outside), or "
                                      "cut a one-sided surface apart.",
                                      name, low, high, list_numbers(here)));
        pair(edges[begin].triangle, edges[begin + 1].triangle);
      }
    }

    /// The pieces that `parents`, of each triangle one before it or itself, make; none for one piece.
    MeshPieces
    pieces_of(std::vector<unsigned int> parents, const std::vector<std::size_t> &element_numbers)
    {
      MeshPieces                pieces;
      std::vector<unsigned int> number(parents.size());
      for (unsigned int t = 0; t < parents.size(); ++t)
      {
        if (parents[t] == t)
        {
          number[t] = pieces.first_elements.size();
          pieces.first_elements.push_back(element_numbers[t]);
        }
        else
          number[t] = number[parents[t]];
        pieces.of_cells.push_back(number[t]);
      }
      return pieces.first_elements.size() == 1 ? MeshPieces() : pieces;
    }

    void
    refuse_joints(const MshFile &contents, const std::string &name, const MeshArrays &mesh)
    {
      std::vector<int>         piece_of(contents.nodes.size(), -1);
      std::vector<std::size_t> joints;
      for (unsigned int t = 0; t < mesh.triangles.size() && !mesh.pieces.empty(); ++t)
        for (const unsigned int node : mesh.triangles[t])
        {
          const auto piece = static_cast<int>(mesh.pieces.of_cells[t]);
          if (piece_of[node] >= 0 && piece_of[node] != piece)
            joints.push_back(contents.node_numbers[node]);
          piece_of[node] = piece;
        }
      std::sort(joints.begin(), joints.end());
      joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
      if (!joints.empty())
        throw UserError(fmt::format(
            "{}: pieces touch at nodes alone, like joints: node {}. Give each piece nodes of its "
            "own, or join the pieces along edges.",
            name, list_numbers(joints)));
    }

    unsigned int
    root(std::vector<unsigned int> &parents, unsigned int t)
    {
      while (parents[t] != t)
        t = parents[t] = parents[parents[t]];
      return t;
    }
  } // namespace

  namespace
  {
    /// The triangles under further physical tags.
    void
    add_further_faces(const MshFile &contents, MeshArrays &mesh)
    {
      std::size_t t = 0;
      for (const MshElement &element : contents.elements)
      {
        if (element.type != MshElementType::triangle)
          continue;
        const auto &nodes = mesh.triangles[t++];
        for (const int tag : further_groups_of(contents, element))
          mesh.further_faces.push_back({ nodes, static_cast<unsigned int>(std::abs(tag)) });
      }
    }
  } // namespace

  MeshArrays
  check_shell(MshFile contents, const std::string &name, const double scale)
  {
    MeshArrays mesh;
    scale_nodes(contents, name, scale);
    if (!contents.note.empty())
      mesh.warnings.push_back(contents.note);
    extract_triangles(contents, name, mesh);
    refuse_thin_triangles(contents, name, mesh);
    refuse_lonely_nodes(contents, name, mesh);

    std::vector<unsigned int> parents(mesh.triangles.size());
    std::iota(parents.begin(), parents.end(), 0U);
    for_each_neighbours(contents, name, mesh, sorted_edges(mesh.triangles),
                        [&](const unsigned int a, const unsigned int b)
                        {
                          const unsigned int of_a = root(parents, a), of_b = root(parents, b);
                          parents[std::max(of_a, of_b)] = std::min(of_a, of_b);
                        });
    mesh.pieces = pieces_of(std::move(parents), mesh.element_numbers);
    refuse_joints(contents, name, mesh);

    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      mesh.boundary_faces.push_back({ mesh.triangles[t], mesh.material_ids[t] });
    add_further_faces(contents, mesh);
    mesh.contents = std::move(contents);
    for (const auto &[group, group_name] : std::map(mesh.contents.physical_names))
      if (group.first == 2) // regions of a shell are surfaces
        mesh.contents.physical_names.emplace(std::pair(3, group.second), group_name);
    return mesh;
  }
} // namespace Exemplar
