// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/halo.h>

#include <deal.II/base/index_set.h>

namespace Exemplar
{
  std::vector<std::size_t>
  first_numbers(const std::size_t n_own, const Exchange &exchange)
  {
    std::vector<std::size_t> firsts{ 0 };
    for (const std::size_t n : exchange.collect({ n_own }))
      firsts.push_back(firsts.back() + n);
    return firsts;
  }

  Halo::Halo(const std::vector<std::size_t> &firsts,
             const std::vector<std::size_t> &others,
             const unsigned int              n_each,
             const Exchange                 &exchange)
  {
    if (firsts.back() == 0) // deal.II makes no partition of nothing
      return;
    dealii::IndexSet own(n_each * firsts.back()), ghosts(n_each * firsts.back());
    own.add_range(n_each * firsts[exchange.process()], n_each * firsts[exchange.process() + 1]);
    for (const std::size_t number : others)
      ghosts.add_range(n_each * number, n_each * (number + 1));
    own.compress();
    ghosts.compress();
    partitioner = std::make_shared<const Partitioner>(own, ghosts, exchange.communicator());
  }

  template <typename Number>
  void
  Halo::share(const Number *own, Number *others) const
  {
    std::vector<Number>             buffer(partitioner->n_import_indices());
    std::vector<MPI_Request>        requests;
    const dealii::ArrayView<Number> ghosts(others, n_others());
    partitioner->export_to_ghosted_array_start(
        0, dealii::ArrayView<const Number>(own, n_own()),
        dealii::ArrayView<Number>(buffer.data(), buffer.size()), ghosts, requests);
    partitioner->export_to_ghosted_array_finish(ghosts, requests);
  }

  template void
  Halo::share(const float *, float *) const;
  template void
  Halo::share(const double *, double *) const;

  void
  Halo::add_to_owners(float *own, float *others) const
  {
    std::vector<float>             buffer(partitioner->n_import_indices());
    std::vector<MPI_Request>       requests;
    const dealii::ArrayView<float> ghosts(others, n_others());
    partitioner->import_from_ghosted_array_start(
        dealii::VectorOperation::add, 0, ghosts,
        dealii::ArrayView<float>(buffer.data(), buffer.size()), requests);
    partitioner->import_from_ghosted_array_finish(
        dealii::VectorOperation::add, dealii::ArrayView<const float>(buffer.data(), buffer.size()),
        dealii::ArrayView<float>(own, n_own()), ghosts, requests);
  }
} // namespace Exemplar
