// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/algebra/mpi_exchange.h>

#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    unsigned int
    rank_in(const MPI_Comm mpi_communicator)
    {
      return dealii::Utilities::MPI::this_mpi_process(mpi_communicator);
    }
  } // namespace

  MpiExchange::MpiExchange(const MPI_Comm mpi_communicator, SharedNodes shared_nodes)
      : mpi_communicator(mpi_communicator), nodes(std::move(shared_nodes)),
        own_process(rank_in(mpi_communicator))
  {
    for (const unsigned int number : nodes.numbers)
      is_owned.push_back(number >= nodes.first_numbers[own_process]
                         && number < nodes.first_numbers[own_process + 1]);
    for (unsigned int node = 0; node < nodes.numbers.size(); ++node)
      (owns(node) ? owned : others).push_back(node);
    for (auto *list : { &owned, &others })
      std::sort(list->begin(), list->end(),
                [this](const unsigned int a, const unsigned int b)
                { return nodes.numbers[a] < nodes.numbers[b]; });
    find_shared_nodes();
  }

  void
  MpiExchange::find_shared_nodes()
  {
    dealii::IndexSet own(nodes.first_numbers.back()), ghosts(nodes.first_numbers.back());
    own.add_range(nodes.first_numbers[own_process], nodes.first_numbers[own_process + 1]);
    for (const unsigned int node : others)
      ghosts.add_index(nodes.numbers[node]);
    own.compress();
    ghosts.compress();
    const Partitioner of_all_nodes(own, ghosts, mpi_communicator);

    std::vector<bool> is_shared(owned.size(), false);
    for (const auto &[begin, end] : of_all_nodes.import_indices())
      std::fill(is_shared.begin() + begin, is_shared.begin() + end, true);
    for (std::size_t i = 0; i < owned.size(); ++i)
      if (is_shared[i])
        shared_owned.push_back(owned[i]);

    const auto own_size = static_cast<unsigned int>(shared_owned.size());
    MPI_Exscan(&own_size, &first_shared, 1, MPI_UNSIGNED, MPI_SUM, mpi_communicator);
    first_shared = own_process == 0 ? 0 : first_shared;
    n_shared     = dealii::Utilities::MPI::sum(own_size, mpi_communicator);

    // owners tell the others the new numbers
    std::vector<double> numbers(owned.size(), 0.), of_others(others.size()),
        buffer(of_all_nodes.n_import_indices());
    for (std::size_t i = 0, next = first_shared; i < owned.size(); ++i)
      if (is_shared[i])
        numbers[i] = static_cast<double>(next++);
    std::vector<MPI_Request> requests;
    of_all_nodes.export_to_ghosted_array_start(
        0, dealii::ArrayView<const double>(numbers.data(), numbers.size()),
        dealii::ArrayView<double>(buffer.data(), buffer.size()),
        dealii::ArrayView<double>(of_others.data(), of_others.size()), requests);
    of_all_nodes.export_to_ghosted_array_finish(
        dealii::ArrayView<double>(of_others.data(), of_others.size()), requests);
    numbers_of_others.assign(of_others.begin(), of_others.end());
  }

  void
  MpiExchange::sum(double *own, const std::size_t n) const
  {
    std::vector<double> all(n * n_processes());
    MPI_Allgather(own, static_cast<int>(n), MPI_DOUBLE, all.data(), static_cast<int>(n), MPI_DOUBLE,
                  mpi_communicator);
    for (std::size_t i = 0; i < n; ++i)
    {
      own[i] = all[i];
      for (unsigned int process = 1; process < n_processes(); ++process)
        own[i] += all[process * n + i];
    }
  }

  double
  MpiExchange::max(const double own) const
  {
    std::vector<double> all(n_processes()); // MPI_MAX would lose a NaN
    MPI_Allgather(&own, 1, MPI_DOUBLE, all.data(), 1, MPI_DOUBLE, mpi_communicator);
    double maximum = all[0];
    for (const double number : all)
      maximum = max_or_nan(maximum, number);
    return maximum;
  }

  std::string
  MpiExchange::first_text(std::string own) const
  {
    const double none  = n_processes();
    const double first = min_of_all(*this, own.empty() ? none : own_process);
    if (first == none)
      return {};
    return dealii::Utilities::MPI::broadcast(mpi_communicator, own,
                                             static_cast<unsigned int>(first));
  }

  void
  MpiExchange::give_from_root(const std::function<std::string()>             &pack,
                              const std::function<void(const std::string &)> &unpack) const
  {
    std::string bytes;
    at_root(*this, [&] { bytes = pack(); });
    unpack(dealii::Utilities::MPI::broadcast(mpi_communicator, bytes, 0));
  }

  std::vector<std::size_t>
  MpiExchange::collect(std::vector<std::size_t> own) const
  {
    std::vector<std::size_t> all;
    for (const auto &part : dealii::Utilities::MPI::all_gather(mpi_communicator, own))
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  std::vector<float>
  MpiExchange::collect(std::vector<float> own, const std::vector<std::size_t> &firsts) const
  {
    std::vector<float> all(firsts.back());
    std::vector<int>   counts;
    for (std::size_t process = 0; process + 1 < firsts.size(); ++process)
      counts.push_back(static_cast<int>(firsts[process + 1] - firsts[process]));
    const std::vector<int> places(firsts.begin(), firsts.end() - 1);
    MPI_Allgatherv(own.data(), static_cast<int>(own.size()), MPI_FLOAT, all.data(), counts.data(),
                   places.data(), MPI_FLOAT, mpi_communicator);
    return all;
  }

  int
  MpiExchange::node_here(const unsigned int in_whole) const
  {
    const auto &all   = nodes.in_files;
    const auto  found = std::lower_bound(all.begin(), all.end(), in_whole);
    return found == all.end() || *found != in_whole ? -1 : static_cast<int>(found - all.begin());
  }

  const MpiExchange::Partitioner &
  MpiExchange::partitioner(const unsigned int n) const
  {
    std::unique_ptr<Partitioner> &found = partitioners[n];
    if (found == nullptr)
    {
      dealii::IndexSet own(n * n_shared), ghosts(n * n_shared);
      own.add_range(n * first_shared, n * (first_shared + shared_owned.size()));
      for (const unsigned int number : numbers_of_others)
        ghosts.add_range(n * number, n * (number + 1));
      own.compress();
      ghosts.compress();
      found = std::make_unique<Partitioner>(own, ghosts, mpi_communicator);
    }
    return *found;
  }

  template <typename Number>
  void
  MpiExchange::exchange_field(Number *field, const unsigned int n, const bool add_first) const
  {
    if (n_shared == 0) // pieces of the body, each in one process
      return;
    const Partitioner       &with = partitioner(n);
    std::vector<Number>      of_owned(n * shared_owned.size()), of_others(n * others.size());
    std::vector<Number>      buffer(with.n_import_indices());
    std::vector<MPI_Request> requests;
    const auto pack = [&](const std::vector<unsigned int> &list, std::vector<Number> &values)
    {
      for (std::size_t i = 0; i < list.size(); ++i)
        std::copy(field + n * list[i], field + n * (list[i] + 1), &values[n * i]);
    };
    const auto unpack
        = [&](const std::vector<unsigned int> &list, const std::vector<Number> &values)
    {
      for (std::size_t i = 0; i < list.size(); ++i)
        std::copy(values.begin() + n * i, values.begin() + n * (i + 1), field + n * list[i]);
    };
    const auto view = [](std::vector<Number> &values)
    { return dealii::ArrayView<Number>(values.data(), values.size()); };
    const auto const_view = [](const std::vector<Number> &values)
    { return dealii::ArrayView<const Number>(values.data(), values.size()); };

    pack(shared_owned, of_owned);
    if (add_first)
    {
      pack(others, of_others);
      with.import_from_ghosted_array_start(dealii::VectorOperation::add, 0, view(of_others),
                                           view(buffer), requests);
      with.import_from_ghosted_array_finish(dealii::VectorOperation::add, const_view(buffer),
                                            view(of_owned), view(of_others), requests);
      unpack(shared_owned, of_owned);
    }
    with.export_to_ghosted_array_start(0, const_view(of_owned), view(buffer), view(of_others),
                                       requests);
    with.export_to_ghosted_array_finish(view(of_others), requests);
    unpack(others, of_others);
  }

  void
  MpiExchange::assemble(double *field, const unsigned int n) const
  {
    exchange_field(field, n, true);
  }

  void
  MpiExchange::assemble(float *field, const unsigned int n) const
  {
    exchange_field(field, n, true);
  }

  void
  MpiExchange::share(Vector &field) const
  {
    exchange_field(field.begin(), 3, false);
  }

  void
  MpiExchange::keep_owned(Vector &field) const
  {
    const std::size_t n = field.size() / nodes.numbers.size();
    for (const unsigned int node : others)
      std::fill(field.begin() + n * node, field.begin() + n * (node + 1), 0.);
  }

  double
  MpiExchange::product(const Vector &a, const Vector &b) const
  {
    double own = 0.;
    for (const unsigned int node : owned)
      for (unsigned int dof = 3 * node; dof < 3 * node + 3; ++dof)
        own += a[dof] * b[dof];
    return Exchange::sum(own);
  }

  std::vector<double>
  MpiExchange::whole(const double      *field,
                     const unsigned int n,
                     std::size_t /*n_nodes*/,
                     const bool everywhere) const
  {
    using namespace dealii::Utilities::MPI;
    std::vector<double>       values;
    std::vector<unsigned int> places;
    for (const unsigned int node : owned)
    {
      values.insert(values.end(), field + n * node, field + n * (node + 1));
      places.push_back(nodes.in_files[node]);
    }
    const auto all_values
        = everywhere ? all_gather(mpi_communicator, values) : gather(mpi_communicator, values);
    const auto all_places
        = everywhere ? all_gather(mpi_communicator, places) : gather(mpi_communicator, places);
    if (all_values.empty()) // gathered elsewhere
      return {};
    std::vector<double> all(n * static_cast<std::size_t>(nodes.first_numbers.back()));
    for (std::size_t process = 0; process < all_places.size(); ++process)
      for (std::size_t i = 0; i < all_places[process].size(); ++i)
        std::copy(&all_values[process][n * i], &all_values[process][n * i] + n,
                  &all[n * static_cast<std::size_t>(all_places[process][i])]);
    return all;
  }

  std::vector<double>
  MpiExchange::part(std::vector<double> whole, const unsigned int n) const
  {
    std::vector<double> own;
    own.reserve(n * nodes.in_files.size());
    for (const std::size_t node : nodes.in_files)
      own.insert(own.end(), whole.begin() + n * node, whole.begin() + n * (node + 1));
    return own;
  }
} // namespace Exemplar
