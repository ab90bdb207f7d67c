// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/distributed_rows.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace Exemplar
{
  namespace
  {
    constexpr std::size_t max_int = std::numeric_limits<int>::max();
  }

  RowNumbers::RowNumbers(const FreeDofs &free_dofs) : with_others(free_dofs.exchange())
  {
    for (const unsigned int dof : free_dofs.list())
    {
      if (own_nodes.empty() || own_nodes.back() != dof / 3)
        own_nodes.push_back(dof / 3);
      own_row_of.push_back(static_cast<int>(3 * (own_nodes.size() - 1) + dof % 3));
    }
    firsts = first_numbers(own_nodes.size(), with_others);
    if (3 * firsts.back() > max_int)
      throw SolverFailure("The matrix has more rows than an int counts. Use a coarser mesh.");

    Vector first_of_node(free_dofs.n_dofs());
    for (std::size_t k = 0; k < own_nodes.size(); ++k)
      first_of_node[3 * own_nodes[k]] = first_row() + 3. * static_cast<double>(k);
    with_others.share(first_of_node);
    for (const unsigned int dof : free_dofs.local_list())
      rows_of_free.push_back(static_cast<int>(first_of_node[dof - dof % 3] + dof % 3));
  }

  int
  RowNumbers::first_row() const
  {
    return static_cast<int>(3 * firsts[with_others.process()]);
  }

  unsigned int
  RowNumbers::owner(const int global_row) const
  {
    const std::size_t node  = global_row / 3;
    const auto        after = std::upper_bound(firsts.begin(), firsts.end(), node);
    return static_cast<unsigned int>(after - firsts.begin()) - 1;
  }

  void
  DistributedRows::reinit(const SymmetricPattern &lower_pattern)
  {
    pattern = &lower_pattern;
    const ByProcess<int> received
        = dealii::Utilities::MPI::some_to_some(numbers.exchange().communicator(), list_foreign());
    number_columns(received);
    insert_couplings(received);
    tidy_rows();
    matrix.value.assign(matrix.column.size(), 0.);
    find_places(received);
    halo = Halo(numbers.first_nodes(), other_nodes, 3, numbers.exchange());
  }

  template <typename Action>
  void
  DistributedRows::for_each_entry(const std::vector<int> &by, const Action &action) const
  {
    for (unsigned int j = 0; j < pattern->n(); ++j)
      for (int entry = pattern->column_start[j]; entry < pattern->column_start[j + 1]; ++entry)
      {
        const int i = pattern->row[entry];
        action(by[i], by[j], entry);
        if (i != static_cast<int>(j))
          action(by[j], by[i], entry);
      }
  }

  DistributedRows::ByProcess<int>
  DistributedRows::list_foreign()
  {
    ByProcess<int> rows_and_columns;
    foreign_entries.clear();
    for_each_entry(
        numbers.global_rows(),
        [&](const int row, const int other, const int entry)
        {
          if (numbers.is_own(row))
            return;
          const unsigned int process = numbers.owner(row);
          rows_and_columns[process].insert(rows_and_columns[process].end(), { row, other });
          foreign_entries[process].push_back(entry);
        });
    return rows_and_columns;
  }

  void
  DistributedRows::number_columns(const ByProcess<int> &received)
  {
    other_nodes.clear();
    const auto add = [this](const int global_column)
    {
      if (!numbers.is_own(global_column))
        other_nodes.push_back(global_column / 3);
    };
    std::for_each(numbers.global_rows().begin(), numbers.global_rows().end(), add);
    for (const auto &[process, rows_and_columns] : received)
      for (std::size_t k = 1; k < rows_and_columns.size(); k += 2)
        add(rows_and_columns[k]);
    std::sort(other_nodes.begin(), other_nodes.end());
    other_nodes.erase(std::unique(other_nodes.begin(), other_nodes.end()), other_nodes.end());

    local_columns.clear();
    for (const int row : numbers.global_rows())
      local_columns.push_back(column_of(row));
  }

  int
  DistributedRows::column_of(const int global_column) const
  {
    if (numbers.is_own(global_column))
      return global_column - numbers.first_row();
    const std::size_t node  = global_column / 3;
    const auto        place = std::lower_bound(other_nodes.begin(), other_nodes.end(), node);
    return static_cast<int>(numbers.n_rows() + 3 * (place - other_nodes.begin()))
           + global_column % 3;
  }

  std::vector<int>
  DistributedRows::global_columns() const
  {
    std::vector<int> all(numbers.n_rows());
    std::iota(all.begin(), all.end(), numbers.first_row());
    for (const std::size_t node : other_nodes)
      for (int c = 0; c < 3; ++c)
        all.push_back(static_cast<int>(3 * node) + c);
    return all;
  }

  template <typename Action>
  void
  DistributedRows::for_each_coupling(const ByProcess<int> &received, const Action &action) const
  {
    for_each_entry(local_columns,
                   [&](const int row, const int other, int /*entry*/)
                   {
                     if (row < static_cast<int>(numbers.n_rows()))
                       action(row, other);
                   });
    for (const auto &[process, rows_and_columns] : received)
      for (std::size_t k = 0; k < rows_and_columns.size(); k += 2)
        action(rows_and_columns[k] - numbers.first_row(), column_of(rows_and_columns[k + 1]));
  }

  void
  DistributedRows::insert_couplings(const ByProcess<int> &received)
  {
    // an entry of several processes is counted more than once at first
    const unsigned int       n = numbers.n_rows();
    std::vector<std::size_t> start(n + 1, 0);
    for_each_coupling(received, [&](const int row, int /*other*/) { ++start[row + 1]; });
    for (unsigned int row = 0; row < n; ++row)
      start[row + 1] = start[row] + std::max<std::size_t>(start[row + 1], 1);
    if (numbers.exchange().any(start.back() > max_int))
      throw SolverFailure("The matrix has more entries than an int counts. Use a coarser mesh.");
    matrix.row_start.assign(start.begin(), start.end());
    matrix.column.resize(start.back());
    for (unsigned int row = 0; row < n; ++row)
      matrix.column[start[row]] = static_cast<int>(row); // diagonal; alone in held rows
    for_each_coupling(received,
                      [&](const int row, const int other) { matrix.column[start[row]++] = other; });
  }

  void
  DistributedRows::tidy_rows()
  {
    std::size_t n_left = 0;
    for (unsigned int row = 0; row < numbers.n_rows(); ++row)
    {
      const auto begin = matrix.column.begin() + matrix.row_start[row],
                 end   = matrix.column.begin() + matrix.row_start[row + 1];
      if (!std::is_sorted(begin, end))
        std::sort(begin, end);
      matrix.row_start[row] = static_cast<int>(n_left);
      const auto after      = std::unique(begin, end);
      n_left = std::copy(begin, after, matrix.column.begin() + n_left) - matrix.column.begin();
    }
    matrix.row_start[numbers.n_rows()] = static_cast<int>(n_left);
    matrix.column.resize(n_left);
    matrix.column.shrink_to_fit();
  }

  int
  DistributedRows::place_of(const int row, const int local_column) const
  {
    return static_cast<int>(std::lower_bound(matrix.column.begin() + matrix.row_start[row],
                                             matrix.column.begin() + matrix.row_start[row + 1],
                                             local_column)
                            - matrix.column.begin());
  }

  void
  DistributedRows::find_places(const ByProcess<int> &received)
  {
    places_of_received.clear();
    for (const auto &[process, rows_and_columns] : received)
      for (std::size_t k = 0; k < rows_and_columns.size(); k += 2)
        places_of_received[process].push_back(place_of(rows_and_columns[k] - numbers.first_row(),
                                                       column_of(rows_and_columns[k + 1])));
  }

  void
  DistributedRows::fill(const std::vector<double> &lower_values,
                        const std::vector<double> &further_diagonal)
  {
    std::fill(matrix.value.begin(), matrix.value.end(), 0.);
    std::vector<bool> is_held(numbers.n_rows(), true);
    for (const int row : numbers.row_of())
      is_held[row] = false;
    for (unsigned int row = 0; row < numbers.n_rows(); ++row)
      if (is_held[row])
        matrix.value[matrix.row_start[row]] = 1.;
    add_own(lower_values);
    add_received(lower_values);
    check_diagonal(further_diagonal);
  }

  void
  DistributedRows::add_own(const std::vector<double> &lower_values)
  {
    const int        n_own = static_cast<int>(numbers.n_rows());
    std::vector<int> next(matrix.row_start.begin(),
                          matrix.row_start.end() - 1); // owned columns ascend
    for_each_entry(local_columns,
                   [&](const int row, const int other, const int entry)
                   {
                     if (row >= n_own)
                       return;
                     int place = next[row];
                     if (other < n_own)
                     {
                       while (matrix.column[place] != other) // skips others' entries
                         ++place;
                       next[row] = place + 1;
                     }
                     else
                       place = place_of(row, other);
                     matrix.value[place] = lower_values[entry];
                   });
  }

  void
  DistributedRows::add_received(const std::vector<double> &lower_values)
  {
    ByProcess<double> values;
    for (const auto &[process, entries] : foreign_entries)
      for (const int entry : entries)
        values[process].push_back(lower_values[entry]);
    values = dealii::Utilities::MPI::some_to_some(numbers.exchange().communicator(), values);
    for (const auto &[process, places] : places_of_received) // sums in the order of the processes
      for (std::size_t k = 0; k < places.size(); ++k)
        matrix.value[places[k]] += values[process][k];
  }

  void
  DistributedRows::check_diagonal(const std::vector<double> &further_diagonal) const
  {
    bool is_positive = true;
    for (unsigned int row = 0; row < numbers.n_rows(); ++row)
    {
      const double further = further_diagonal.empty() ? 0. : further_diagonal[row];
      is_positive = is_positive && matrix.value[place_of(row, row)] + further > 0.; // NaN fails
    }
    if (numbers.exchange().any(!is_positive))
      throw indefinite_matrix();
  }

  void
  DistributedRows::multiply(const Vector &vector, Vector &image) const
  {
    std::vector<double> all(halo.n_others());
    halo.share(vector.begin(), all.data());
    const double *x = vector.begin();
    if (!all.empty())
    {
      all.insert(all.begin(), x, x + numbers.n_rows());
      x = all.data();
    }
    for (unsigned int row = 0; row < numbers.n_rows(); ++row)
    {
      double sum = 0.;
      for (int entry = matrix.row_start[row]; entry < matrix.row_start[row + 1]; ++entry)
        sum += matrix.value[entry] * x[matrix.column[entry]];
      image[row] = sum;
    }
  }

  std::size_t
  DistributedRows::memory_consumption() const
  {
    return sizeof(int)
               * (matrix.row_start.capacity() + matrix.column.capacity() + local_columns.capacity())
           + sizeof(double) * matrix.value.capacity();
  }
} // namespace Exemplar
