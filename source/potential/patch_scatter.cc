// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/patch_scatter.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    std::vector<unsigned int>
    nodes_of(const Patches &patches, const FESpace &fe_space, const unsigned int patch)
    {
      std::vector<unsigned int> nodes;
      for (const unsigned int cell : patches.cells(patch))
        nodes.insert(nodes.end(), fe_space.nodes(cell).begin(), fe_space.nodes(cell).end());
      std::sort(nodes.begin(), nodes.end());
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      return nodes;
    }
  } // namespace

  PatchScatter::PatchScatter(const Patches  &patches,
                             const FESpace  &fe_space,
                             const FreeDofs &free_dofs)
      : patches(patches), fe_space(fe_space), free_dofs(free_dofs), dofs_of_patch(patches.size()),
        beside_held(patches.size(), false)
  {
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      for (const unsigned int node : nodes_of(patches, fe_space, patch))
        for (unsigned int c = 0; c < 3; ++c)
        {
          dofs_of_patch[patch].push_back(3 * node + c);
          if (free_dofs.free_index(3 * node + c) == FreeDofs::held)
            beside_held[patch] = true;
        }
  }

  std::vector<std::pair<unsigned int, unsigned int>>
  PatchScatter::couplings(const Patches &patches, const FESpace &fe_space)
  {
    std::vector<std::pair<unsigned int, unsigned int>> pairs;
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      const std::vector<unsigned int> nodes = nodes_of(patches, fe_space, patch);
      for (std::size_t a = 0; a < nodes.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
          pairs.emplace_back(nodes[b], nodes[a]);
    }
    return pairs;
  }

  void
  PatchScatter::gradient(const unsigned int   patch,
                         const CellField     &cells,
                         std::vector<double> &b) const
  {
    const std::vector<unsigned int> &dofs = dofs_of_patch[patch];
    b.assign(dofs.size(), 0.);
    for (const unsigned int cell : patches.cells(patch))
    {
      const Tetrahedron<double> &tet      = fe_space.tetrahedron(cell);
      const Matrix3<double>      R        = cells.rotation(cell);
      const double               fraction = tet.volume / patches.volume(patch);
      for (unsigned int a = 0; a < 4; ++a)
      {
        const Vector3<double> Rg = R * tet.shape_gradient[a];
        const auto place = std::lower_bound(dofs.begin(), dofs.end(), 3 * fe_space.nodes(cell)[a])
                           - dofs.begin();
        for (unsigned int c = 0; c < 3; ++c)
          b[place + c] += fraction * Rg[c];
      }
    }
  }

  void
  PatchScatter::add_product(const unsigned int         patch,
                            const double               factor,
                            const std::vector<double> &b,
                            const SymmetricPattern    &pattern,
                            std::vector<double>       &values) const
  {
    const std::vector<unsigned int> &dofs = dofs_of_patch[patch];
    for (std::size_t j = 0; j < dofs.size(); ++j)
    {
      const int column = free_dofs.free_index(dofs[j]);
      if (column == FreeDofs::held)
        continue;
      // the rows of a column ascend as those of the patch do, which are among them
      std::size_t position = pattern.column_start[column];
      for (std::size_t i = j; i < dofs.size(); ++i)
        if (const int row = free_dofs.free_index(dofs[i]); row != FreeDofs::held)
        {
          while (pattern.row[position] != row)
            ++position;
          values[position] += factor * b[i] * b[j];
        }
    }
  }

  void
  PatchScatter::add_column(const unsigned int         patch,
                           const double               factor,
                           const std::vector<double> &b,
                           double                    *column) const
  {
    const std::vector<unsigned int> &dofs = dofs_of_patch[patch];
    for (std::size_t i = 0; i < dofs.size(); ++i)
      if (const int index = free_dofs.free_index(dofs[i]); index != FreeDofs::held)
        column[index] += factor * b[i];
  }

  std::size_t
  PatchScatter::memory_consumption() const
  {
    return dealii::MemoryConsumption::memory_consumption(dofs_of_patch);
  }
} // namespace Exemplar
