// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/patches.h>
#include <exemplar/mesh/mesh_checks.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <queue>

namespace Exemplar
{
  namespace
  {
    constexpr unsigned int no_patch = static_cast<unsigned int>(-1);

    /// The kind of a cell: material id, sign and octave of lambda. Only cells of one kind share a
    /// patch.
    using Kind = std::array<int, 3>;

    std::vector<Kind>
    kinds_of_cells(const std::vector<unsigned int> &material_ids, const Material &material)
    {
      std::vector<Kind> kinds(material_ids.size());
      for (unsigned int cell = 0; cell < kinds.size(); ++cell)
      {
        const double lambda = material.lambda_of_patches(cell);
        int          octave = 0;
        std::frexp(lambda, &octave);
        kinds[cell] = { { static_cast<int>(material_ids[cell]), lambda < 0. ? -1 : 1, octave } };
      }
      return kinds;
    }

    std::vector<std::vector<unsigned int>>
    cells_by_node(const std::vector<std::array<unsigned int, 4>> &cells, const unsigned int n_nodes)
    {
      std::vector<std::vector<unsigned int>> around(n_nodes);
      for (unsigned int cell = 0; cell < cells.size(); ++cell)
        for (const unsigned int node : cells[cell])
          around[node].push_back(cell);
      return around;
    }

    constexpr unsigned int no_cell = static_cast<unsigned int>(-1);

    /// The cells that share a face with each cell; no_cell at the boundary.
    std::vector<std::array<unsigned int, 4>>
    cells_beside(const std::vector<std::array<unsigned int, 4>> &cells)
    {
      std::vector<std::array<unsigned int, 4>> beside(cells.size(),
                                                      { { no_cell, no_cell, no_cell, no_cell } });
      const std::vector<CellFace>              faces = sorted_faces({ cells, {}, {} });
      const auto                               add   = [&](const CellFace &face, const CellFace &of)
      { *std::find(beside[of.cell].begin(), beside[of.cell].end(), no_cell) = face.cell; };
      for (std::size_t i = 1; i < faces.size(); ++i)
        if (faces[i].nodes == faces[i - 1].nodes)
        {
          add(faces[i], faces[i - 1]);
          add(faces[i - 1], faces[i]);
        }
      return beside;
    }

    /// The algorithm of Patches::choose() for linear elements.
    class Stars
    {
    public:
      Stars(const std::vector<std::array<unsigned int, 4>> &cells,
            const unsigned int                              n_mesh_nodes,
            const std::vector<Kind>                        &kinds)
          : cells(cells), kinds(kinds), around(cells_by_node(cells, n_mesh_nodes)),
            beside(cells_beside(cells)), patch(cells.size(), no_patch)
      {
        for (const std::size_t minimum : { 18, 9 }) // at an inner node there are 24 on average
        {
          take_stars(minimum);
          join_neighbours(0);
        }
        join_neighbours(1);
        take_stars(1); // remaining cells have no neighbour of their kind with a patch
      }

      std::vector<unsigned int>
      take()
      {
        return std::move(patch);
      }

    private:
      /// The cells at a node without a patch, of their most frequent kind.
      std::vector<unsigned int>
      star(const unsigned int node) const
      {
        std::map<Kind, std::vector<unsigned int>> free;
        for (const unsigned int cell : around[node])
          if (patch[cell] == no_patch)
            free[kinds[cell]].push_back(cell);
        std::vector<unsigned int> maximum;
        for (auto &[kind, of_kind] : free)
          if (of_kind.size() > maximum.size())
            maximum = std::move(of_kind);
        return maximum;
      }

      /// Turn stars of `minimum` cells or more into patches, the greatest first.
      void
      take_stars(const std::size_t minimum)
      {
        // ordered by number of cells, then by least node; entries may be outdated by later patches
        using Entry = std::pair<std::size_t, long>;
        std::priority_queue<Entry> queue;
        const auto                 push = [&](const unsigned int node)
        {
          if (const std::size_t n = star(node).size(); n >= minimum)
            queue.emplace(n, -static_cast<long>(node));
        };
        for (unsigned int node = 0; node < around.size(); ++node)
          push(node);
        while (!queue.empty())
        {
          const auto [n_cells, minus_node] = queue.top();
          queue.pop();
          const auto                      node    = static_cast<unsigned int>(-minus_node);
          const std::vector<unsigned int> of_star = star(node);
          if (of_star.size() == n_cells)
            add_patch(of_star);
          push(node);
        }
      }

      void
      add_patch(const std::vector<unsigned int> &of_star)
      {
        n_cells.push_back(0);
        nodes.emplace_back();
        for (const unsigned int cell : of_star)
          assign(cell, n_cells.size() - 1);
      }

      void
      assign(const unsigned int cell, const unsigned int to)
      {
        patch[cell] = to;
        ++n_cells[to];
        for (const unsigned int node : cells[cell])
          if (const auto place = std::lower_bound(nodes[to].begin(), nodes[to].end(), node);
              place == nodes[to].end() || *place != node)
            nodes[to].insert(place, node);
      }

      /// Let cells without a patch join one with which they share a face, as long as it gains at
      /// most `max_gain` nodes; always the cell with the best choice next.
      void
      join_neighbours(const int max_gain)
      {
        std::priority_queue<Choice, std::vector<Choice>, std::greater<>> queue;
        const auto push = [&](const unsigned int cell)
        {
          if (patch[cell] == no_patch)
            if (const Choice choice = best_choice(cell); choice[0] <= max_gain)
              queue.push(choice);
        };
        for (unsigned int cell = 0; cell < patch.size(); ++cell)
          push(cell);
        while (!queue.empty())
        {
          const Choice choice = queue.top();
          queue.pop();
          const unsigned int cell = choice[3];
          if (patch[cell] != no_patch || choice != best_choice(cell))
          {
            push(cell);
            continue;
          }
          assign(cell, choice[4]);
          push_improved(cell, choice[0] > 0, push);
        }
      }

      /// Push the cells whose choice may be better since `cell` has a patch: those behind its faces, and, if the patch
      /// has gained a node, those at the nodes of `cell`.
      template <typename Push>
      void
      push_improved(const unsigned int cell, const bool gained_nodes, const Push &push) const
      {
        if (gained_nodes)
          for (const unsigned int node : cells[cell])
            for (const unsigned int other : around[node])
              push(other);
        else
          for (const unsigned int other : beside[cell])
            if (other != no_cell)
              push(other);
      }

      /// Sort key of a cell's choice of a patch, less is better: number of nodes gained, minus the
      /// number of common faces, number of cells of the patch, cell, patch.
      using Choice = std::array<int, 5>;

      Choice
      best_choice(const unsigned int cell) const
      {
        Choice                            best       = { { 4, 0, 0, static_cast<int>(cell), 0 } };
        const std::array<unsigned int, 4> candidates = patches_beside(cell);
        for (unsigned int face = 0; face < 4; ++face)
        {
          const unsigned int candidate = candidates[face];
          if (candidate == no_patch)
            continue;
          const auto n_faces
              = static_cast<int>(std::count(candidates.begin(), candidates.end(), candidate));
          // two faces have all four nodes
          const int gain
              = n_faces > 1 ? 0 : !has_node(candidate, node_off(cell, beside[cell][face]));
          best = std::min(best, Choice{ { gain, -n_faces, n_cells[candidate],
                                          static_cast<int>(cell), static_cast<int>(candidate) } });
        }
        return best;
      }

      /// The node of a cell that the cell behind one of its faces does not have.
      unsigned int
      node_off(const unsigned int cell, const unsigned int behind) const
      {
        const std::array<unsigned int, 4> &others = cells[behind];
        return *std::find_if(cells[cell].begin(), cells[cell].end(),
                             [&](const unsigned int node) {
                               return std::find(others.begin(), others.end(), node) == others.end();
                             });
      }

      bool
      has_node(const unsigned int of_patch, const unsigned int node) const
      {
        return std::binary_search(nodes[of_patch].begin(), nodes[of_patch].end(), node);
      }

      /// The patches, of a cell's kind, behind its faces; no_patch where there is none.
      std::array<unsigned int, 4>
      patches_beside(const unsigned int cell) const
      {
        std::array<unsigned int, 4> patches;
        for (unsigned int face = 0; face < 4; ++face)
        {
          const unsigned int other = beside[cell][face];
          patches[face] = other != no_cell && kinds[other] == kinds[cell] ? patch[other] : no_patch;
        }
        return patches;
      }

      const std::vector<std::array<unsigned int, 4>> &cells;
      const std::vector<Kind>                        &kinds;
      const std::vector<std::vector<unsigned int>>    around;  ///< the cells at each node
      const std::vector<std::array<unsigned int, 4>>  beside;  ///< cells_beside()
      std::vector<unsigned int>                       patch;   ///< patch of each cell
      std::vector<int>                                n_cells; ///< number of cells of each patch
      std::vector<std::vector<unsigned int>>          nodes;   ///< of each patch, ascending
    };
  } // namespace

  std::vector<unsigned int>
  Patches::choose(const Mesh &mesh, const Material &material, const Element element)
  {
    if (traits_of(element).locks)
      return Stars(mesh.get_cells(), mesh.n_nodes(),
                   kinds_of_cells(mesh.get_material_ids(), material))
          .take();
    std::vector<unsigned int> cells(mesh.n_cells());
    std::iota(cells.begin(), cells.end(), 0u);
    return cells;
  }

  Patches::Patches(const std::vector<unsigned int> &of_cells,
                   const FESpace                   &fe_space,
                   const Material                  &material)
  {
    if (of_cells.empty())
      return;
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
      patch_of_point.push_back(of_cells[fe_space.cell_of(point)]);
    const unsigned int n = 1 + *std::max_element(patch_of_point.begin(), patch_of_point.end());
    points_of_patch.resize(n);
    volumes.assign(n, 0.);
    for (unsigned int point = 0; point < patch_of_point.size(); ++point)
    {
      const unsigned int patch  = patch_of_point[point];
      const double       volume = fe_space.volume(point);
      points_of_patch[patch].push_back(point);
      volumes[patch] += volume;
    }
    set_material(fe_space, material);
  }

  void
  Patches::set_material(const FESpace &fe_space, const Material &material)
  {
    lambdas.assign(size(), 0.);
    for (unsigned int point = 0; point < patch_of_point.size(); ++point)
      lambdas[patch_of_point[point]]
          += fe_space.volume(point) * material.lambda_of_patches(fe_space.cell_of(point));
    for (unsigned int patch = 0; patch < size(); ++patch)
      lambdas[patch] /= volumes[patch];
  }

  std::size_t
  Patches::memory_consumption() const
  {
    using dealii::MemoryConsumption::memory_consumption;
    return memory_consumption(patch_of_point) + memory_consumption(points_of_patch)
           + memory_consumption(volumes) + memory_consumption(lambdas);
  }
} // namespace Exemplar
