// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/cell_batches.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>
#include <numeric>

namespace Exemplar
{
  CellBatches::CellBatches(const FESpace     &fe_space,
                           const Material    &of_cells,
                           const LawsOfCells &laws)
      : n_points(fe_space.n_points()), n_nodes(nodes_per_cell(fe_space.element())),
        nodes(batched_size(n_points, n_nodes)), gradients(batched_size(n_points, 3 * n_nodes - 3)),
        volumes(batched_size(n_points, 1)),
        material(batched_size(n_points, CellMaterial<double>::n_numbers)),
        rotations(batched_size(n_points, 9))
  {
    std::vector<unsigned int> order(n_nodes);
    // slots behind the last point repeat it, without a volume
    for (std::size_t slot = 0; slot < volumes.size(); ++slot)
    {
      const auto point      = static_cast<unsigned int>(std::min(slot, n_points - 1));
      const auto cell       = fe_space.cell_of(point);
      const auto cell_nodes = fe_space.nodes(cell);
      const auto shape      = fe_space.gradients(point);
      std::iota(order.begin(), order.end(), 0u);
      std::sort(order.begin(), order.end(),
                [&](const unsigned int a, const unsigned int b)
                { return cell_nodes[a] < cell_nodes[b]; });
      for (std::size_t a = 0; a < n_nodes; ++a)
      {
        nodes[batch_index(slot, n_nodes, a)] = static_cast<int>(cell_nodes[order[a]]);
        for (std::size_t i = 0; i < 3 && a > 0; ++i)
          gradients[batch_index(slot, 3 * n_nodes - 3, 3 * (a - 1) + i)] = shape[order[a]][i];
      }
      volumes[slot]                   = slot < n_points ? fe_space.volume(point) : 0.;
      constexpr std::size_t n_numbers = CellMaterial<double>::n_numbers;
      for (std::size_t k = 0; k < n_numbers; ++k)
        material[batch_index(slot, n_numbers, k)] = of_cells.elasticity(cell).number(k);
      for (const unsigned int diagonal : { 0, 4, 8 })
        rotations[batch_index(slot, 9, diagonal)] = 1.;
    }
    for (const CellLaw law : laws.present())
    {
      of_laws.push_back({ law, {} });
      if (laws.present().size() == 1)
        return;
      of_laws.back().volumes.resize(volumes.size(), 0.);
      for (unsigned int point = 0; point < n_points; ++point)
        if (laws[fe_space.cell_of(point)] == law)
          of_laws.back().volumes[point] = volumes[point];
    }
  }

  CellArrays
  CellBatches::arrays(const double guard_bound)
  {
    return { n_points,        nodes.data(),     gradients.data(),    volumes.data(),
             material.data(), rotations.data(), of_laws.front().law, guard_bound };
  }

  std::size_t
  CellBatches::memory_consumption() const
  {
    return dealii::MemoryConsumption::memory_consumption(nodes) + gradients.memory_consumption()
           + volumes.memory_consumption() + material.memory_consumption() + rotations.memory_consumption();
  }
} // namespace Exemplar
