// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/cell_batches.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace Exemplar
{
  CellBatches::CellBatches(const FESpace &fe_space, const Material &material)
      : n_cells(fe_space.n_cells()), nodes(batched_size(n_cells, 4)),
        gradients(batched_size(n_cells, 9)), volumes(batched_size(n_cells, 1)),
        lame(batched_size(n_cells, 2)), rotations(batched_size(n_cells, 9))
  {
    for (std::size_t place = 0; place < volumes.size(); ++place)
    {
      const auto                  cell  = static_cast<unsigned int>(std::min(place, n_cells - 1));
      const Tetrahedron<double>  &tet   = fe_space.tetrahedron(cell);
      std::array<unsigned int, 4> order = { { 0, 1, 2, 3 } };
      std::sort(order.begin(), order.end(),
                [&](const unsigned int a, const unsigned int b)
                { return fe_space.nodes(cell)[a] < fe_space.nodes(cell)[b]; });
      for (unsigned int a = 0; a < 4; ++a)
      {
        const Vector3<double> &g = tet.shape_gradient[order[a]];

        nodes[batch_index(place, 4, a)] = static_cast<int>(fe_space.nodes(cell)[order[a]]);
        for (unsigned int i = 0; i < 3 && a > 0; ++i)
          gradients[batch_index(place, 9, 3 * (a - 1) + i)] = g[i];
      }
      volumes[place]                 = place < n_cells ? tet.volume : 0.;
      lame[batch_index(place, 2, 0)] = material.elasticity(cell).lambda;
      lame[batch_index(place, 2, 1)] = material.elasticity(cell).mu;
      for (const unsigned int diagonal : { 0, 4, 8 })
        rotations[batch_index(place, 9, diagonal)] = 1.;
    }
  }

  CellArrays
  CellBatches::arrays(const StrainMeasure strain, const double guard_bound)
  {
    return { n_cells,     nodes.data(),     gradients.data(), volumes.data(),
             lame.data(), rotations.data(), strain,           guard_bound };
  }

  std::size_t
  CellBatches::memory_consumption() const
  {
    return dealii::MemoryConsumption::memory_consumption(nodes) + gradients.memory_consumption()
           + volumes.memory_consumption() + lame.memory_consumption()
           + rotations.memory_consumption();
  }
} // namespace Exemplar
