// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/lanes.h>
#include <exemplar/potential/nodal_sums.h>

#include <algorithm>

namespace Exemplar
{
  NodalSums::NodalSums(const FESpace &fe_space, const unsigned int n_threads)
      : n_batches((fe_space.n_points() + batch_size - 1) / batch_size), n_nodes(fe_space.n_nodes()),
        stripes(std::clamp<std::size_t>(fe_space.n_points() / 50000, 2, 16)),
        // to start a thread costs as much as a thousand cells
        n_at_once(fe_space.n_points() < 4000 ? 1 : static_cast<int>(n_threads)),
        values(4 * stripes * n_nodes)
  {
  }

  void
  NodalSums::add_to(Vector &forces, Vector &scales) const
  {
    for (std::size_t node = 0; node < n_nodes; ++node)
    {
      double sum[4] = {};
      for (std::size_t stripe = 0; stripe < stripes; ++stripe)
        for (unsigned int c = 0; c < 4; ++c)
          sum[c] += values[4 * (stripe * n_nodes + node) + c];
      for (unsigned int c = 0; c < 3; ++c)
        forces[3 * node + c] += sum[c];
      scales[node] += sum[3];
    }
  }
} // namespace Exemplar
