// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_halo_h
#define exemplar_halo_h

#include <exemplar/algebra/exchange.h>

#include <deal.II/base/partitioner.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace Exemplar
{
  /// Global numbering, consecutive on each process: the first number of each process, of which this
  /// one has `n_own`, and the total. Collective.
  std::vector<std::size_t>
  first_numbers(std::size_t n_own, const Exchange &exchange);

  /// Ghost entries of distributed vectors: copies of entries that other processes own. A single
  /// process has none.
  class Halo
  {
  public:
    /// The halo of empty vectors.
    Halo() = default;

    /// The halo of vectors with `n_each` numbers for each item. Items are numbered globally from
    /// `firsts` on, see first_numbers(); `others`, ascending, are the numbers of the ghost items.
    Halo(const std::vector<std::size_t> &firsts,
         const std::vector<std::size_t> &others,
         unsigned int                    n_each,
         const Exchange                 &exchange);

    /// Number of owned entries.
    std::size_t
    n_own() const
    {
      return partitioner->locally_owned_size();
    }

    std::size_t
    n_others() const
    {
      return partitioner->n_ghost_indices();
    }

    /// Update ghosts: copy the owners' entries to `others`. This and the next are collective.
    template <typename Number>
    void
    share(const Number *own, Number *others) const;

    /// Add the ghosts to their owners' entries, and set them to zero.
    void
    add_to_owners(float *own, float *others) const;

  private:
    using Partitioner = dealii::Utilities::MPI::Partitioner;

    std::shared_ptr<const Partitioner> partitioner = std::make_shared<const Partitioner>();
  };
} // namespace Exemplar

#endif
