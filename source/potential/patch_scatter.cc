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
      for (const unsigned int point : patches.points(patch))
        for (const unsigned int node : fe_space.nodes(fe_space.cell_of(point)))
          nodes.push_back(node);
      std::sort(nodes.begin(), nodes.end());
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      return nodes;
    }
  } // namespace

  PatchScatter::PatchScatter(const Patches          &patches,
                             const FESpace          &fe_space,
                             const SymmetricPattern &pattern,
                             const FreeDofs         &free_dofs,
                             const bool              has_couplings)
      : patches(patches), fe_space(fe_space), free_dofs(free_dofs), pattern(pattern),
        layouts(patches.size())
  {
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      Layout &layout = layouts[patch];
      layout.nodes   = nodes_of(patches, fe_space, patch);
      for (const unsigned int point : patches.points(patch))
        for (const unsigned int node : fe_space.nodes(fe_space.cell_of(point)))
          layout.places.push_back(std::lower_bound(layout.nodes.begin(), layout.nodes.end(), node)
                                  - layout.nodes.begin());
      for (unsigned int place = 0; place < layout.nodes.size(); ++place)
      {
        for (unsigned int c = 0; c < 3; ++c)
          if (free_dofs.free_index(3 * layout.nodes[place] + c) != FreeDofs::held)
            layout.free_dofs.push_back(3 * place + c);
        layout.node_ends.push_back(layout.free_dofs.size());
      }
      if (has_couplings)
        find_entries(layout);
    }
  }

  int
  PatchScatter::free_index(const Layout &layout, const unsigned int i) const
  {
    const unsigned int dof = layout.free_dofs[i];
    return free_dofs.free_index(3 * layout.nodes[dof / 3] + dof % 3);
  }

  void
  PatchScatter::find_entries(Layout &layout) const
  {
    for (unsigned int j = 0; j < layout.free_dofs.size(); ++j)
      for (unsigned int place = layout.free_dofs[j] / 3, i = j; place < layout.nodes.size();
           i = layout.node_ends[place++])
        if (i < layout.node_ends[place]) // not all of the node is held
          layout.entries.push_back(pattern.position(free_index(layout, i), free_index(layout, j)));
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
    const Layout &layout = layouts[patch];
    b.assign(3 * layout.nodes.size(), 0.);
    auto place = layout.places.begin();
    for (const unsigned int point : patches.points(patch))
    {
      const Matrix3<double> R        = cells.rotation(point);
      const double          fraction = fe_space.volume(point) / patches.volume(patch);
      for (const Vector3<double> &g : fe_space.gradients(point))
      {
        const Vector3<double> Rg = R * g;
        for (unsigned int c = 0; c < 3; ++c)
          b[3 * *place + c] += fraction * Rg[c];
        ++place;
      }
    }
  }

  template <typename Function>
  void
  PatchScatter::for_each_value(const Layout        &layout,
                               std::vector<double> &values,
                               const Function      &add) const
  {
    auto entry = layout.entries.begin();
    for (unsigned int j = 0; j < layout.free_dofs.size(); ++j)
      for (unsigned int place = layout.free_dofs[j] / 3, i = j; place < layout.nodes.size();
           ++place)
      {
        const unsigned int end = layout.node_ends[place];
        if (i == end)
          continue;
        double *value = &values[*entry++];
        if (end == i + 3) // nearly always; this is the inner loop of the assembly
        {
          add(i, j, value[0]);
          add(i + 1, j, value[1]);
          add(i + 2, j, value[2]);
          i = end;
        }
        else
          for (; i < end; ++i)
            add(i, j, *value++);
      }
  }

  std::vector<double>
  PatchScatter::free_part(const Layout &layout, const std::vector<double> &u) const
  {
    std::vector<double> result(layout.free_dofs.size());
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] = u[layout.free_dofs[i]];
    return result;
  }

  void
  PatchScatter::add_square(const unsigned int         patch,
                           const double               factor,
                           const std::vector<double> &u,
                           std::vector<double>       &values) const
  {
    const std::vector<double> free_u = free_part(layouts[patch], u);
    std::vector<double>       v      = free_u;
    for (double &entry : v)
      entry *= factor;
    for_each_value(layouts[patch], values,
                   [u = free_u.data(), v = v.data()](const unsigned int i, const unsigned int j,
                                                     double &value) { value += v[j] * u[i]; });
  }

  void
  PatchScatter::add_matrix(const unsigned int                patch,
                           const dealii::FullMatrix<double> &matrix,
                           std::vector<double>              &values) const
  {
    const std::vector<unsigned int> &free = layouts[patch].free_dofs;
    for_each_value(layouts[patch], values,
                   [&](const unsigned int i, const unsigned int j, double &value)
                   { value += matrix(free[i], free[j]); });
  }

  void
  PatchScatter::add_cells(const unsigned int                patch,
                          const dealii::FullMatrix<double> &matrix,
                          std::vector<double>              &values) const
  {
    const Layout                    &layout = layouts[patch];
    const std::vector<unsigned int> &free   = layout.free_dofs;
    for (unsigned int j = 0; j < free.size(); ++j)
      for (unsigned int i = j; i < free.size(); ++i)
        if (const double value = matrix(free[i], free[j]); value != 0.)
          values[pattern.position(free_index(layout, i), free_index(layout, j))] += value;
  }

  void
  PatchScatter::add_column(const unsigned int         patch,
                           const double               factor,
                           const std::vector<double> &b,
                           double                    *column) const
  {
    const Layout &layout = layouts[patch];
    for (const unsigned int dof : layout.free_dofs)
      column[free_dofs.free_index(3 * layout.nodes[dof / 3] + dof % 3)] += factor * b[dof];
  }

  std::size_t
  PatchScatter::memory_consumption() const
  {
    using dealii::MemoryConsumption::memory_consumption;
    std::size_t bytes = layouts.size() * sizeof(Layout);
    for (const Layout &layout : layouts)
      bytes += memory_consumption(layout.nodes) + memory_consumption(layout.places)
               + memory_consumption(layout.free_dofs) + memory_consumption(layout.node_ends)
               + memory_consumption(layout.entries);
    return bytes;
  }
} // namespace Exemplar
