// SPDX-License-Identifier: GPL-3.0-or-later
// Orders of nodes: https://gmsh.info/doc/texinfo/gmsh.html, "Node ordering".
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/mesh/mesh_edges.h>
#include <exemplar/mesh/msh_nodes.h>
#include <exemplar/mesh/quadratic_msh.h>

#include <fmt/core.h>

#include <algorithm>
#include <optional>

namespace Exemplar
{
  namespace
  {
    using Edge = std::array<unsigned int, 2>;

    /// A linear element and the quadratic one of the same shape: the corners, and then the middles
    /// of the first edges between these corners.
    struct ElementPair
    {
      unsigned int linear, quadratic;
      std::size_t  n_corners, n_edges;
    };

    constexpr ElementPair element_pairs[]
        = { { MshElementType::line, MshElementType::quadratic_line, 2, 1 },
            { MshElementType::triangle, MshElementType::quadratic_triangle, 3, 3 },
            { MshElementType::tetrahedron, MshElementType::quadratic_tetrahedron, 4, 6 } };

    constexpr unsigned int gmsh_edges[6][2]
        = { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 3, 0 }, { 2, 3 }, { 1, 3 } };

    const ElementPair *
    find_pair(const unsigned int type, unsigned int ElementPair::*const kind)
    {
      const auto *const pair = std::find_if(std::begin(element_pairs), std::end(element_pairs),
                                            [&](const ElementPair &p) { return p.*kind == type; });
      return pair != std::end(element_pairs) ? pair : nullptr;
    }

    void
    check_straight(const MshFile     &msh,
                   const MshElement  &element,
                   const ElementPair &pair,
                   const std::string &name)
    {
      for (std::size_t e = 0; e < pair.n_edges; ++e)
      {
        const std::size_t a = element.nodes[gmsh_edges[e][0]], b = element.nodes[gmsh_edges[e][1]];
        const std::size_t m   = element.nodes[pair.n_corners + e];
        const auto        off = msh.nodes[m] - (msh.nodes[a] + 0.5 * (msh.nodes[b] - msh.nodes[a]));
        const double      length = msh.nodes[a].distance(msh.nodes[b]);
        if (off.norm() <= 1e-6 * length)
          continue;
        throw UserError(fmt::format(
            "{}: element {} has a curved edge: node {} lies beside the middle of nodes {} and {} "
            "by {} of their distance. Edges must be straight at rest, of quadratic elements, too. "
            "In gmsh mesh with first order (Mesh.ElementOrder = 1) or with Mesh.SecondOrderLinear "
            "= 1; Model/Element = P2 then puts nodes into the middles of edges.",
            name, element.number, msh.node_numbers[m], msh.node_numbers[a], msh.node_numbers[b],
            short_text(off.norm() / length)));
      }
    }

    std::vector<const MshElement *>
    elements_of(const MshFile &msh, const unsigned int type)
    {
      std::vector<const MshElement *> elements;
      for (const MshElement &element : msh.elements)
        if (element.type == type)
          elements.push_back(&element);
      return elements;
    }

    std::vector<std::array<unsigned int, 4>>
    corners_of(const std::vector<const MshElement *> &tetrahedra)
    {
      std::vector<std::array<unsigned int, 4>> corners;
      for (const MshElement *const tetrahedron : tetrahedra)
      {
        corners.emplace_back();
        for (unsigned int v = 0; v < 4; ++v)
          corners.back()[v] = static_cast<unsigned int>(tetrahedron->nodes[v]);
      }
      return corners;
    }

    /// Index of the edge between two nodes, if it exists.
    std::optional<unsigned int>
    find_if_there(const std::vector<Edge> &edges, const std::size_t a, const std::size_t b)
    {
      const Edge edge = { { static_cast<unsigned int>(std::min(a, b)),
                            static_cast<unsigned int>(std::max(a, b)) } };
      if (const unsigned int found = find_edge(edges, edge[0], edge[1]);
          found < edges.size() && edges[found] == edge)
        return found;
      return {};
    }
  } // namespace

  bool
  has_quadratic_tetrahedra(const MshFile &msh)
  {
    return std::any_of(msh.elements.begin(), msh.elements.end(),
                       [](const MshElement &element)
                       { return element.type == MshElementType::quadratic_tetrahedron; });
  }

  void
  take_corners(MshFile &msh, const std::string &name)
  {
    std::vector<bool> is_middle(msh.nodes.size(), false), keep(msh.nodes.size(), true);
    for (MshElement &element : msh.elements)
    {
      const ElementPair *const pair = find_pair(element.type, &ElementPair::quadratic);
      if (pair == nullptr)
        continue;
      check_straight(msh, element, *pair, name);
      for (std::size_t m = pair->n_corners; m < element.nodes.size(); ++m)
        is_middle[element.nodes[m]] = true;
      element.type = pair->linear;
      element.nodes.resize(pair->n_corners);
    }
    // sets of nodes name middles, too, which a selection of the ends of an edge includes
    msh.elements.erase(std::remove_if(msh.elements.begin(), msh.elements.end(),
                                      [&](const MshElement &element) {
                                        return element.type == MshElementType::point
                                               && is_middle[element.nodes[0]];
                                      }),
                       msh.elements.end());
    keep = is_middle;
    keep.flip();
    for (const MshElement &element : msh.elements)
      for (const std::size_t node : element.nodes)
        keep[node] = true;
    remove_nodes(msh, keep);
    msh.note += (msh.note.empty() ? "" : " ") + name
                + ": has 10-node tetrahedra with straight edges, of which the corners are taken. "
                  "Model/Element = P2 puts nodes into the middles of the edges again, P1 does "
                  "without.";
  }

  std::vector<dealii::Point<3>>
  quadratic_pose(const MshFile &pose, const MshFile &mesh, const std::string &prefix)
  {
    const auto expected = elements_of(mesh, MshElementType::tetrahedron);
    const auto found    = elements_of(pose, MshElementType::quadratic_tetrahedron);
    if (found.size() != expected.size())
      throw UserError(fmt::format("{}has {} 10-node tetrahedra, the mesh has {} tetrahedra. A pose "
                                  "must have those of the mesh, in the same order.",
                                  prefix, found.size(), expected.size()));
    const std::vector<Edge>       edges = edges_of(corners_of(expected));
    std::vector<dealii::Point<3>> places(mesh.nodes.size() + edges.size());
    std::vector<std::size_t>      middles(edges.size(), pose.nodes.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
    {
      const auto &nodes = expected[i]->nodes, &posed = found[i]->nodes;
      for (unsigned int v = 0; v < 4; ++v)
      {
        if (pose.node_numbers[posed[v]] != mesh.node_numbers[nodes[v]])
          throw UserError(
              fmt::format("{}corner {} of tetrahedron {} (element {}) is node {}, in the mesh node "
                          "{}. A pose must have the tetrahedra of the mesh, in the same order and "
                          "with the same numbers of their corners.",
                          prefix, v + 1, i + 1, found[i]->number, pose.node_numbers[posed[v]],
                          mesh.node_numbers[nodes[v]]));
        places[nodes[v]] = pose.nodes[posed[v]];
      }
      for (unsigned int e = 0; e < 6; ++e)
      {
        const unsigned int edge
            = find_edge(edges, static_cast<unsigned int>(nodes[gmsh_edges[e][0]]),
                        static_cast<unsigned int>(nodes[gmsh_edges[e][1]]));
        const std::size_t node = posed[4 + e];
        if (middles[edge] != pose.nodes.size() && middles[edge] != node)
          throw UserError(fmt::format(
              "{}the edge between nodes {} and {} has two nodes in its middle, {} and {}. Cells "
              "that share an edge must share its node: save the mesh anew.",
              prefix, mesh.node_numbers[edges[edge][0]], mesh.node_numbers[edges[edge][1]],
              pose.node_numbers[node], pose.node_numbers[middles[edge]]));
        middles[edge]                    = node;
        places[mesh.nodes.size() + edge] = pose.nodes[node];
      }
    }
    return places;
  }

  MshFile
  with_middles(const MshFile                       &mesh,
               const std::vector<Edge>             &edges,
               const std::vector<dealii::Point<3>> &places)
  {
    MshFile result      = mesh;
    result.nodes        = places;
    std::size_t maximum = *std::max_element(mesh.node_numbers.begin(), mesh.node_numbers.end());
    while (result.node_numbers.size() < places.size())
      result.node_numbers.push_back(++maximum);
    for (MshElement &element : result.elements)
    {
      const ElementPair *const pair  = find_pair(element.type, &ElementPair::linear);
      std::vector<std::size_t> nodes = element.nodes;
      for (std::size_t e = 0; pair != nullptr && e < pair->n_edges; ++e)
        if (const auto edge = find_if_there(edges, element.nodes[gmsh_edges[e][0]],
                                            element.nodes[gmsh_edges[e][1]]))
          nodes.push_back(mesh.nodes.size() + *edge);
      if (pair == nullptr || nodes.size() < pair->n_corners + pair->n_edges)
        continue;
      element.type  = pair->quadratic;
      element.nodes = nodes;
    }
    return result;
  }
} // namespace Exemplar
