// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_nodal_sums_h
#define exemplar_nodal_sums_h

#include <exemplar/algebra/vector.h>
#include <exemplar/base/loop_parts.h>
#include <exemplar/kernels/cell_kernels.h>

#include <deal.II/base/aligned_vector.h>

#include <vector>

namespace Exemplar
{
  /// Sums at the nodes, of forces [N] and their sizes, that loops over the cells add to. Cells are
  /// summed in stripes, each by one thread. Which these are depends on the mesh alone, so that the
  /// sums do not depend on the number of threads. Where a node has cells of several stripes, the first
  /// of these adds to the node itself, each other one to a place of its own behind all nodes.
  class NodalSums
  {
  public:
    /// Places for the sums of cells with `nodes_per_cell` nodes each.
    NodalSums(const CellArrays &cells,
              std::size_t       nodes_per_cell,
              std::size_t       n_nodes,
              unsigned int      n_threads);

    void
    clear()
    {
      values.fill(0.);
    }

    std::size_t
    n_stripes() const
    {
      return stripes;
    }

    /// How many threads loops over the body take.
    int
    n_threads() const
    {
      return n_at_once;
    }

    /// CellTask::places.
    const int *
    get_places() const
    {
      return places.data();
    }

    /// Call function(stripe, begin, end, sums) for the batches from begin to end - 1 of each stripe,
    /// which add four numbers at each of their places.
    template <typename Function>
    void
    for_each_stripe(const Function &function)
    {
      for_each_part(stripes, n_batches, n_at_once,
                    [&](const std::size_t stripe, const std::size_t begin, const std::size_t end)
                    { function(stripe, begin, end, values.data()); });
    }

    /// Nodes and the places behind them.
    std::size_t
    n_places() const
    {
      return n_nodes + shared.size();
    }

    /// Add to the n numbers of each node those of its other places.
    template <typename Number>
    void
    join(Number *sums, const std::size_t n) const
    {
      for (std::size_t i = 0; i < shared.size(); ++i)
        for (std::size_t k = 0; k < n; ++k)
          sums[n * shared[i] + k] += sums[n * (n_nodes + i) + k];
    }

    /// Copy them to vectors by degree of freedom and by node, which get their sizes.
    void
    copy_to(Vector &forces, Vector &scales);

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    void
    find_places(const CellArrays &cells, std::size_t nodes_per_cell);

    const std::size_t             n_batches;
    const std::size_t             n_nodes;
    const int                     n_at_once; ///< threads
    std::size_t                   stripes;
    std::vector<int>              places; ///< in batches, as CellArrays::nodes
    std::vector<unsigned int>     shared; ///< the nodes of the places behind all nodes
    dealii::AlignedVector<double> values; ///< four a place
  };
} // namespace Exemplar

#endif
