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
  /// Things that are numbered one process after the other: the first of each process if this one
  /// has `n_own`, and the number of all. All processes must call this.
  std::vector<std::size_t>
  first_numbers(std::size_t n_own, const Exchange &exchange);

  /// What a process needs of vectors beside its own numbers: copies of those of others. In one
  /// process there are none.
  class Halo
  {
  public:
    /// Of empty vectors.
    Halo() = default;

    /// Of vectors with `n_each` numbers for each of the things that are numbered from `firsts` on,
    /// as first_numbers() tells. `others` of other processes are needed here, ascending.
    Halo(const std::vector<std::size_t> &firsts,
         const std::vector<std::size_t> &others,
         unsigned int                    n_each,
         const Exchange                 &exchange);

    /// Numbers that this process owns.
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

    /// From the own numbers of all processes to those that `others` are copies of. All processes
    /// must call this and the next.
    template <typename Number>
    void
    share(const Number *own, Number *others) const;

    /// Add `others` to the own numbers of those who own them; they are zero afterwards.
    void
    add_to_owners(float *own, float *others) const;

  private:
    using Partitioner = dealii::Utilities::MPI::Partitioner;

    std::shared_ptr<const Partitioner> partitioner = std::make_shared<const Partitioner>();
  };
} // namespace Exemplar

#endif
