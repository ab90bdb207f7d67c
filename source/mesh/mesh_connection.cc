// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/mesh_checks.h>

#include <fmt/core.h>

#include <algorithm>
#include <numeric>
#include <optional>

// find_pieces(), and its message about pieces that touch.

namespace Exemplar
{
  namespace
  {
    /// Components of the mesh that are connected through faces (union by smaller root).
    class Components
    {
    public:
      explicit Components(const std::size_t n_cells) : parents(n_cells)
      {
        std::iota(parents.begin(), parents.end(), 0U);
      }

      unsigned int
      root(unsigned int cell)
      {
        while (parents[cell] != cell)
          cell = parents[cell] = parents[parents[cell]];
        return cell;
      }

      void
      join(const unsigned int a, const unsigned int b)
      {
        const auto [low, high] = std::minmax({ root(a), root(b) }); // braces: by value
        parents[high]          = low;
      }

    private:
      std::vector<unsigned int> parents;
    };

    /// Nodes that cells of different components have in common.
    std::vector<bool>
    find_shared_nodes(const std::size_t n_nodes, const Tetrahedra &tetrahedra, Components &parts)
    {
      std::vector<bool>                        shared(n_nodes, false);
      std::vector<std::optional<unsigned int>> part_of(n_nodes);
      for (unsigned int cell = 0; cell < tetrahedra.nodes.size(); ++cell)
        for (const unsigned int node : tetrahedra.nodes[cell])
        {
          if (!part_of[node])
            part_of[node] = parts.root(cell);
          if (*part_of[node] != parts.root(cell))
            shared[node] = true;
        }
      return shared;
    }

    /// Whether an edge belongs to cells of different components.
    bool
    share_an_edge(const std::vector<bool> &shared, const Tetrahedra &tetrahedra, Components &parts)
    {
      std::vector<std::array<unsigned int, 3>> edges; // both nodes, and the component
      for (unsigned int cell = 0; cell < tetrahedra.nodes.size(); ++cell)
        for (const unsigned int a : tetrahedra.nodes[cell])
          for (const unsigned int b : tetrahedra.nodes[cell])
            if (a < b && shared[a] && shared[b])
              edges.push_back({ { a, b, parts.root(cell) } });
      std::sort(edges.begin(), edges.end());
      for (std::size_t i = 1; i < edges.size(); ++i)
        if (edges[i][0] == edges[i - 1][0] && edges[i][1] == edges[i - 1][1]
            && edges[i][2] != edges[i - 1][2])
          return true;
      return false;
    }

    /// Throws UserError where pieces have nodes in common.
    void
    refuse_hinges(const MshFile     &contents,
                  const std::string &name,
                  const Tetrahedra  &tetrahedra,
                  const MeshPieces  &pieces,
                  Components        &parts)
    {
      const std::vector<bool>  shared = find_shared_nodes(contents.nodes.size(), tetrahedra, parts);
      std::vector<std::size_t> numbers;
      for (std::size_t node = 0; node < shared.size(); ++node)
        if (shared[node])
          numbers.push_back(contents.node_numbers[node]);
      if (numbers.empty())
        return;
      throw UserError(fmt::format(
          "{}: has {} parts that no common face connects, beginning with element {}. Parts touch "
          "only at {}, like a hinge: node {}. Join the volumes in the geometry (BooleanUnion, or "
          "BooleanFragments and Coherence), keep one of them, or give each nodes of its own.",
          name, pieces.first_elements.size(), list_numbers(pieces.first_elements),
          share_an_edge(shared, tetrahedra, parts) ? "an edge" : "a node", list_numbers(numbers)));
    }
  } // namespace

  MeshPieces
  find_pieces(const MshFile               &contents,
              const std::string           &name,
              const Tetrahedra            &tetrahedra,
              const std::vector<CellFace> &faces)
  {
    const auto n_cells = static_cast<unsigned int>(tetrahedra.nodes.size());
    Components parts(n_cells);
    for (std::size_t i = 1; i < faces.size(); ++i)
      if (faces[i].nodes == faces[i - 1].nodes)
        parts.join(faces[i].cell, faces[i - 1].cell);

    MeshPieces                pieces;
    std::vector<unsigned int> numbers(n_cells); // of the piece that a cell is the root of
    for (unsigned int cell = 0; cell < n_cells; ++cell)
    {
      if (parts.root(cell) == cell) // no cell before it is of this piece
      {
        numbers[cell] = pieces.first_elements.size();
        pieces.first_elements.push_back(tetrahedra.element_numbers[cell]);
      }
      pieces.of_cells.push_back(numbers[parts.root(cell)]);
    }
    if (pieces.first_elements.size() == 1)
      return {};
    refuse_hinges(contents, name, tetrahedra, pieces, parts);
    return pieces;
  }
} // namespace Exemplar
