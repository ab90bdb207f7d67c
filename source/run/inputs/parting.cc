// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/mesh_checks.h>
#include <exemplar/mesh/mesh_edges.h>
#include <exemplar/run/inputs/parting.h>

#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/sparsity_tools.h>

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <string>

namespace Exemplar
{
  namespace
  {
    /// The graph of lumps (patches or cells) with an edge between two that share a face.
    dealii::SparsityPattern
    dual_graph(const std::vector<CellFace>     &faces,
               const std::vector<unsigned int> &lump_of_cell,
               const unsigned int               n_lumps)
    {
      std::vector<unsigned int> row_lengths(n_lumps, 1); // one for the diagonal
      std::vector<std::pair<std::size_t, std::size_t>> edges;
      for (std::size_t i = 1; i < faces.size(); ++i)
        if (faces[i].nodes == faces[i - 1].nodes)
        {
          const unsigned int a = lump_of_cell[faces[i - 1].cell], b = lump_of_cell[faces[i].cell];
          if (a == b)
            continue;
          edges.emplace_back(a, b);
          ++row_lengths[a];
          ++row_lengths[b];
        }
      dealii::SparsityPattern pattern(n_lumps, n_lumps, row_lengths);
      for (const auto &[a, b] : edges)
      {
        pattern.add(a, b);
        pattern.add(b, a);
      }
      pattern.compress();
      return pattern;
    }

    /// The lump of each cell, which is not divided: its patch, or the cell itself.
    std::vector<unsigned int>
    lumps_of(const Mesh &mesh, const std::vector<unsigned int> &patches)
    {
      std::vector<unsigned int> lumps = patches;
      if (lumps.empty())
      {
        lumps.resize(mesh.n_cells());
        std::iota(lumps.begin(), lumps.end(), 0u);
      }
      return lumps;
    }

    /// The process of each cell.
    std::vector<unsigned int>
    partition(const Mesh                      &mesh,
              const std::vector<unsigned int> &lumps,
              const std::vector<CellFace>     &faces,
              const unsigned int               n_processes)
    {
      const unsigned int        n_lumps = 1 + *std::max_element(lumps.begin(), lumps.end());
      std::vector<unsigned int> weights(n_lumps, 0), process_of(n_lumps, 0);
      for (const unsigned int lump : lumps)
        ++weights[lump];
      if (n_processes <= n_lumps)
        dealii::SparsityTools::partition(dual_graph(faces, lumps, n_lumps), weights, n_processes,
                                         process_of);
      std::vector<bool> has_cells(n_processes, false);
      for (const unsigned int process : process_of)
        has_cells[process] = true;
      if (std::find(has_cells.begin(), has_cells.end(), false) != has_cells.end())
        throw UserError(
            fmt::format("{}: {} processes are more than its {} cells are enough for{}. Start fewer "
                        "with mpirun -n.",
                        mesh.get_name(), n_processes, mesh.n_cells(),
                        n_lumps == mesh.n_cells() ? "" : " in patches that stay whole"));
      return chosen(process_of, lumps);
    }

    std::array<unsigned int, 3>
    ascending_nodes(const BoundaryFace &face)
    {
      std::array<unsigned int, 3> nodes = face.nodes;
      std::sort(nodes.begin(), nodes.end());
      return nodes;
    }

    /// Assign each face of the boundary to the process of its cell, and each further face to that of its first cell.
    void
    give_faces(const Mesh                      &mesh,
               const std::vector<CellFace>     &faces,
               const std::vector<unsigned int> &process_of_cell,
               std::vector<PartOfBody>         &parts)
    {
      std::map<std::array<unsigned int, 3>, unsigned int> number;
      for (unsigned int face = 0; face < mesh.get_boundary_faces().size(); ++face)
        number[ascending_nodes(mesh.get_boundary_faces()[face])] = face;
      std::multimap<std::array<unsigned int, 3>, unsigned int> further;
      for (unsigned int face = 0; face < mesh.get_further_faces().size(); ++face)
        further.emplace(ascending_nodes(mesh.get_further_faces()[face]), face);
      for (const CellFace &face : faces)
      {
        PartOfBody &part = parts[process_of_cell[face.cell]];
        if (const auto found = number.find(face.nodes); found != number.end())
          part.faces.push_back(found->second);
        const auto [begin, end] = further.equal_range(face.nodes);
        for (auto found = begin; found != end; ++found)
          part.further_faces.push_back(found->second);
        further.erase(begin, end);
      }
      for (PartOfBody &part : parts)
        for (std::vector<unsigned int> *const some : { &part.faces, &part.further_faces })
          std::sort(some->begin(), some->end());
    }

    /// Assign all nodes of its cells to each process.
    void
    give_nodes(const Mesh                                     &mesh,
               const std::vector<std::array<unsigned int, 2>> &edges,
               std::vector<PartOfBody>                        &parts)
    {
      for (PartOfBody &part : parts)
      {
        std::vector<unsigned int> &nodes = part.nodes.in_files;
        for (const unsigned int cell : part.cells)
        {
          const auto &corners = mesh.get_cells()[cell];
          nodes.insert(nodes.end(), corners.begin(), corners.end());
          for (const auto &[a, b] : cell_edges)
            if (!edges.empty())
              nodes.push_back(mesh.n_nodes() + find_edge(edges, corners[a], corners[b]));
        }
        std::sort(nodes.begin(), nodes.end());
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      }
    }

    /// Number the nodes. Owners of shared nodes are chosen among their processes in turn.
    void
    number_nodes(const std::size_t n_nodes, std::vector<PartOfBody> &parts)
    {
      std::vector<unsigned int> n_sharers(n_nodes, 0), n_seen(n_nodes, 0), numbers(n_nodes),
          first_numbers{ 0 };
      for (const PartOfBody &part : parts)
        for (const unsigned int node : part.nodes.in_files)
          ++n_sharers[node];
      for (const PartOfBody &part : parts)
      {
        unsigned int next = first_numbers.back();
        for (const unsigned int node : part.nodes.in_files)
          if (n_seen[node]++ == node % n_sharers[node])
            numbers[node] = next++;
        first_numbers.push_back(next);
      }
      for (PartOfBody &part : parts)
      {
        part.nodes.numbers       = chosen(numbers, part.nodes.in_files);
        part.nodes.first_numbers = first_numbers;
      }
    }
  } // namespace

  std::vector<PartOfBody>
  part_body(const Mesh                      &mesh,
            const std::vector<unsigned int> &patches,
            const Element                    element,
            const unsigned int               n_processes)
  {
    const std::vector<CellFace>     faces = sorted_faces({ mesh.get_cells(), {}, {} });
    const std::vector<unsigned int> process_of_cell
        = partition(mesh, lumps_of(mesh, patches), faces, n_processes);
    std::vector<PartOfBody> parts(n_processes);
    for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
      parts[process_of_cell[cell]].cells.push_back(cell);
    give_faces(mesh, faces, process_of_cell, parts);
    const auto edges = element == Element::P2 ? edges_of(mesh.get_cells())
                                              : std::vector<std::array<unsigned int, 2>>();
    give_nodes(mesh, edges, parts);
    number_nodes(mesh.n_nodes() + edges.size(), parts);
    return parts;
  }
} // namespace Exemplar
