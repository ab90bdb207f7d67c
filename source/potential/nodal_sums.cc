// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/nodal_sums.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>

namespace Exemplar
{
  NodalSums::NodalSums(const CellArrays  &cells,
                       const std::size_t  nodes_per_cell,
                       const std::size_t  n_nodes,
                       const unsigned int n_threads)
      : n_batches(cells.n_batches()), n_nodes(n_nodes),
        // to start a thread costs as much as a thousand cells
        n_at_once(cells.n_cells < 4000 ? 1 : static_cast<int>(n_threads)),
        stripes(cells.n_cells < 4000 ? 1 : std::clamp<std::size_t>(cells.n_cells / 6000, 2, 16))
  {
    find_places(cells, nodes_per_cell);
    // where the cells of a mesh are in no order, stripes share most nodes
    while (stripes > 2 && shared.size() > 2 * n_nodes)
    {
      stripes /= 2;
      find_places(cells, nodes_per_cell);
    }
    values.resize(4 * n_places());
  }

  void
  NodalSums::find_places(const CellArrays &cells, const std::size_t nodes_per_cell)
  {
    const std::size_t        per_batch = nodes_per_cell * batch_size;
    std::vector<std::size_t> last_stripe(n_nodes, stripes); // none yet
    std::vector<int>         place(n_nodes);
    places.resize(per_batch * n_batches);
    shared.clear();
    for_each_part(stripes, n_batches, 1,
                  [&](const std::size_t stripe, const std::size_t begin, const std::size_t end)
                  {
                    for (std::size_t i = per_batch * begin; i < per_batch * end; ++i)
                    {
                      const int node = cells.nodes[i];
                      if (last_stripe[node] == stripes)
                        place[node] = node;
                      else if (last_stripe[node] != stripe)
                      {
                        place[node] = static_cast<int>(n_nodes + shared.size());
                        shared.push_back(node);
                      }
                      last_stripe[node] = stripe;
                      places[i]         = place[node];
                    }
                  });
  }

  void
  NodalSums::copy_to(Vector &forces, Vector &scales)
  {
    join(values.data(), 4);
    forces.reinit(3 * n_nodes, true);
    scales.reinit(n_nodes, true);
    for (std::size_t node = 0; node < n_nodes; ++node)
    {
      for (unsigned int c = 0; c < 3; ++c)
        forces[3 * node + c] = values[4 * node + c];
      scales[node] = values[4 * node + 3];
    }
  }

  std::size_t
  NodalSums::memory_consumption() const
  {
    using dealii::MemoryConsumption::memory_consumption;
    return memory_consumption(places) + memory_consumption(shared) + values.memory_consumption();
  }
} // namespace Exemplar
