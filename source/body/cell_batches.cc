// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/cell_batches.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace Exemplar
{
  CellBatches::CellBatches(const FESpace  &fe_space,
                           const Material &body_material,
                           const bool      has_patches)
      : n_cells(fe_space.n_cells()), nodes(batched_size(n_cells, 4)),
        gradients(batched_size(n_cells, 9)), volumes(batched_size(n_cells, 1)),
        material(batched_size(n_cells, CellMaterial<double>::n_numbers)),
        guard_material(has_patches ? material.size() : 0), rotations(batched_size(n_cells, 9))
  {
    // slots behind the last cell repeat it, without a volume
    for (std::size_t slot = 0; slot < volumes.size(); ++slot)
    {
      const auto                  cell  = static_cast<unsigned int>(std::min(slot, n_cells - 1));
      const Tetrahedron<double>  &tet   = fe_space.tetrahedron(cell);
      std::array<unsigned int, 4> order = { { 0, 1, 2, 3 } };
      std::sort(order.begin(), order.end(),
                [&](const unsigned int a, const unsigned int b)
                { return fe_space.nodes(cell)[a] < fe_space.nodes(cell)[b]; });
      for (unsigned int a = 0; a < 4; ++a)
      {
        const Vector3<double> &g = tet.shape_gradient[order[a]];

        nodes[batch_index(slot, 4, a)] = static_cast<int>(fe_space.nodes(cell)[order[a]]);
        for (unsigned int i = 0; i < 3 && a > 0; ++i)
          gradients[batch_index(slot, 9, 3 * (a - 1) + i)] = g[i];
      }
      volumes[slot] = slot < n_cells ? tet.volume : 0.;
      store_material(body_material.elasticity(cell), slot);
      for (const unsigned int diagonal : { 0, 4, 8 })
        rotations[batch_index(slot, 9, diagonal)] = 1.;
    }
  }

  void
  CellBatches::store_material(const CellMaterial<double> &elasticity, const std::size_t slot)
  {
    constexpr std::size_t      n         = CellMaterial<double>::n_numbers;
    const bool                 has_parts = !guard_material.empty();
    const CellMaterial<double> acting    = has_parts ? elasticity.without_dilatation() : elasticity;
    for (std::size_t k = 0; k < n; ++k)
    {
      material[batch_index(slot, n, k)] = acting.number(k);
      if (has_parts)
        guard_material[batch_index(slot, n, k)] = elasticity.number(k);
    }
  }

  CellArrays
  CellBatches::arrays(const StrainMeasure strain, const double guard_bound)
  {
    return { n_cells,          nodes.data(),
             gradients.data(), volumes.data(),
             material.data(),  guard_material.empty() ? material.data() : guard_material.data(),
             rotations.data(), strain,
             guard_bound };
  }

  std::size_t
  CellBatches::memory_consumption() const
  {
    return dealii::MemoryConsumption::memory_consumption(nodes) + gradients.memory_consumption()
           + volumes.memory_consumption() + material.memory_consumption()
           + guard_material.memory_consumption() + rotations.memory_consumption();
  }
} // namespace Exemplar
