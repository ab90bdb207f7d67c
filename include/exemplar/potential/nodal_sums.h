// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_nodal_sums_h
#define exemplar_nodal_sums_h

#include <exemplar/algebra/vector.h>
#include <exemplar/base/environment.h>
#include <exemplar/body/fe_space.h>

#include <deal.II/base/aligned_vector.h>

#include <cstddef>

namespace Exemplar
{
  /// Sums at the nodes, of forces [N] and their sizes, that loops over the cells add to. Cells are
  /// summed in stripes, each by one thread. How many there are depends on the mesh alone, so that the
  /// sums do not depend on the number of threads.
  class NodalSums
  {
  public:
    NodalSums(const FESpace &fe_space, unsigned int n_threads);

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

    /// Call function(stripe, begin, end, sums) for the batches from begin to end - 1 of each stripe,
    /// which add four numbers a node to the stripe's sums.
    template <typename Function>
    void
    for_each_stripe(const Function &function);

    /// Add all stripes, one after the other, to vectors by degree of freedom and by node.
    void
    add_to(Vector &forces, Vector &scales) const;

    /// In bytes.
    std::size_t
    memory_consumption() const
    {
      return values.memory_consumption();
    }

  private:
    const std::size_t             n_batches;
    const std::size_t             n_nodes;
    const std::size_t             stripes;
    const int                     n_at_once; ///< threads
    dealii::AlignedVector<double> values;    ///< stripe by stripe
  };

  template <typename Function>
  void
  NodalSums::for_each_stripe(const Function &function)
  {
    const OpenMPScope scope(OpenMPScope::Threads::several);
#pragma omp parallel for num_threads(n_at_once)
    for (std::size_t stripe = 0; stripe < stripes; ++stripe)
      function(stripe, stripe * n_batches / stripes, (stripe + 1) * n_batches / stripes,
               &values[4 * stripe * n_nodes]);
  }
} // namespace Exemplar

#endif
