// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/multigrid_operator.h>

#include <deal.II/base/mpi.h>

#include <Epetra_MpiComm.h>
#include <Epetra_Vector.h>
#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

namespace Exemplar
{
  namespace
  {
    /// Lists for other processes, or from them, by their numbers.
    template <typename Number>
    using ByProcess = std::map<unsigned int, std::vector<Number>>;

    /// In several processes. Rows have global numbers, consecutive for the unknowns of a process.
    /// Columns have local numbers: those of the own rows, then those of the other nodes that they
    /// are coupled with, three a node. Not all of these are nodes of this process' cells: the
    /// cells of others couple shared nodes with nodes that are theirs alone.
    class DistributedOperator : public MultigridOperator
    {
    public:
      DistributedOperator(const FreeDofs &free_dofs, const double tolerance)
          : MultigridOperator(free_dofs, tolerance), exchange(free_dofs.exchange())
      {
        number_rows();
      }

    private:
      void
      make_matrix(const SymmetricPattern &new_pattern) override
      {
        pattern = new_pattern;
        const ByProcess<int> received
            = dealii::Utilities::MPI::some_to_some(exchange.communicator(), list_foreign());
        number_columns(received);
        insert_couplings(received);
        find_places(received);
      }

      void
      number_rows()
      {
        first_rows.push_back(0);
        for (const std::size_t n_own : exchange.collect({ n_rows() }))
          first_rows.push_back(first_rows.back() + n_own);
        if (first_rows.back() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
          throw SolverFailure(
              "The matrix has more rows than Epetra can count. Use a coarser mesh.");
        first_row = static_cast<int>(first_rows[exchange.process()]);

        Vector first_of_node(free_dofs.n_dofs());
        for (std::size_t k = 0; k < nodes.size(); ++k)
          first_of_node[3 * nodes[k]] = first_row + 3. * static_cast<double>(k);
        exchange.share(first_of_node);
        for (const unsigned int dof : free_dofs.local_list())
          global_rows.push_back(static_cast<int>(first_of_node[dof - dof % 3] + dof % 3));
      }

      bool
      is_own(const int global_row) const
      {
        return global_row >= first_row && global_row < first_row + static_cast<int>(n_rows());
      }

      unsigned int
      owner(const int global_row) const
      {
        const auto after = std::upper_bound(first_rows.begin(), first_rows.end(), global_row);
        return static_cast<unsigned int>(after - first_rows.begin()) - 1;
      }

      /// Call action(row, column, entry) for all entries of both triangles, by the numbers of
      /// `numbers`; in each row the columns ascend by the order of the degrees of freedom.
      template <typename Action>
      void
      for_each_entry(const std::vector<int> &numbers, const Action &action) const
      {
        for (unsigned int j = 0; j < pattern.n(); ++j)
          for (int entry = pattern.column_start[j]; entry < pattern.column_start[j + 1]; ++entry)
          {
            const int i = pattern.row[entry];
            action(numbers[i], numbers[j], entry);
            if (i != static_cast<int>(j))
              action(numbers[j], numbers[i], entry);
          }
      }

      /// Row and column, one after the other, of what this process' cells add to the rows of
      /// others; remembers where these values are.
      ByProcess<int>
      list_foreign()
      {
        ByProcess<int> rows_and_columns;
        foreign_entries.clear();
        for_each_entry(
            global_rows,
            [&](const int row, const int column, const int entry)
            {
              if (is_own(row))
                return;
              const unsigned int process = owner(row);
              rows_and_columns[process].insert(rows_and_columns[process].end(), { row, column });
              foreign_entries[process].push_back(entry);
            });
        return rows_and_columns;
      }

      void
      number_columns(const ByProcess<int> &received)
      {
        other_nodes.clear();
        const auto add = [this](const int column)
        {
          if (!is_own(column))
            other_nodes.push_back(column - column % 3);
        };
        std::for_each(global_rows.begin(), global_rows.end(), add);
        for (const auto &[process, rows_and_columns] : received)
          for (std::size_t k = 1; k < rows_and_columns.size(); k += 2)
            add(rows_and_columns[k]);
        std::sort(other_nodes.begin(), other_nodes.end());
        other_nodes.erase(std::unique(other_nodes.begin(), other_nodes.end()), other_nodes.end());

        columns.clear();
        for (const int row : global_rows)
          columns.push_back(column_of(row));
      }

      /// The local number of a column.
      int
      column_of(const int global_row) const
      {
        if (is_own(global_row))
          return global_row - first_row;
        const auto place
            = std::lower_bound(other_nodes.begin(), other_nodes.end(), global_row - global_row % 3);
        return static_cast<int>(n_rows() + 3 * (place - other_nodes.begin())) + global_row % 3;
      }

      void
      insert_couplings(const ByProcess<int> &received)
      {
        // an entry that several processes know is counted more than once at first
        std::vector<std::size_t> start(n_rows() + 1, 0);
        for_each_coupling(received, [&](const int row, int /*column*/) { ++start[row + 1]; });
        for (unsigned int row = 0; row < n_rows(); ++row)
          start[row + 1] = start[row] + std::max<std::size_t>(start[row + 1], 1);
        check_size(start.back());
        std::vector<int>         row_columns(start.back());
        std::vector<std::size_t> next(start.begin(), start.end() - 1);
        for (unsigned int row = 0; row < n_rows(); ++row)
          row_columns[start[row]] = static_cast<int>(row); // of held components this remains
        for_each_coupling(received, [&](const int row, const int column)
                          { row_columns[next[row]++] = column; });
        std::vector<int> length(n_rows());
        int              longest = 0;
        for (unsigned int row = 0; row < n_rows(); ++row)
        {
          const auto begin = row_columns.begin() + start[row],
                     end   = row_columns.begin() + start[row + 1];
          if (!std::is_sorted(begin, end))
            std::sort(begin, end);
          length[row] = static_cast<int>(std::unique(begin, end) - begin);
          longest     = std::max(longest, length[row]);
        }

        const Epetra_MpiComm communicator(exchange.communicator());
        const Epetra_Map     rows(-1, static_cast<int>(n_rows()), 0, communicator);
        matrix = std::make_unique<Epetra_CrsMatrix>(Copy, rows, column_map(communicator),
                                                    length.data(), true);
        const std::vector<double> ones(longest, 1.);
        for (unsigned int row = 0; row < n_rows(); ++row)
          matrix->InsertMyValues(static_cast<int>(row), length[row], ones.data(),
                                 row_columns.data() + start[row]);
        matrix->FillComplete();
        matrix->OptimizeStorage();
      }

      /// Call action(row, column), by local numbers, for all couplings of own rows.
      template <typename Action>
      void
      for_each_coupling(const ByProcess<int> &received, const Action &action) const
      {
        for_each_entry(columns,
                       [&](const int row, const int column, int /*entry*/)
                       {
                         if (row < static_cast<int>(n_rows()))
                           action(row, column);
                       });
        for (const auto &[process, rows_and_columns] : received)
          for (std::size_t k = 0; k < rows_and_columns.size(); k += 2)
            action(rows_and_columns[k] - first_row, column_of(rows_and_columns[k + 1]));
      }

      Epetra_Map
      column_map(const Epetra_MpiComm &communicator) const
      {
        std::vector<int> all(n_rows());
        std::iota(all.begin(), all.end(), first_row);
        for (const int first : other_nodes)
          all.insert(all.end(), { first, first + 1, first + 2 });
        return { -1, static_cast<int>(all.size()), all.data(), 0, communicator };
      }

      /// Where in the matrix the values go that other processes send.
      void
      find_places(const ByProcess<int> &received)
      {
        int    *start = nullptr, *column = nullptr;
        double *value = nullptr;
        matrix->ExtractCrsDataPointers(start, column, value);
        places_of_received.clear();
        for (const auto &[process, rows_and_columns] : received)
          for (std::size_t k = 0; k < rows_and_columns.size(); k += 2)
          {
            const int row = rows_and_columns[k] - first_row;
            places_of_received[process].push_back(
                static_cast<int>(std::lower_bound(column + start[row], column + start[row + 1],
                                                  column_of(rows_and_columns[k + 1]))
                                 - column));
          }
      }

      void
      fill_matrix() override
      {
        int    *start = nullptr, *column = nullptr;
        double *value = nullptr;
        matrix->ExtractCrsDataPointers(start, column, value);
        std::fill(value, value + start[n_rows()], 0.);
        std::vector<bool> is_held(n_rows(), true);
        for (const int row : row_of)
          is_held[row] = false;
        for (unsigned int row = 0; row < n_rows(); ++row)
          if (is_held[row])
            value[start[row]] = 1.;
        add_own(start, column, value);
        add_received(value);
        Epetra_Vector diagonal(matrix->RowMap());
        matrix->ExtractDiagonalCopy(diagonal);
        if (exchange.any(!std::all_of(diagonal.Values(), diagonal.Values() + n_rows(),
                                      [](const double entry) { return entry > 0.; }))) // nor a NaN
          throw indefinite_matrix();
      }

      void
      add_own(const int *start, const int *column, double *value) const
      {
        const int        n_own = static_cast<int>(n_rows());
        std::vector<int> next(start, start + n_own); // own columns come in their order
        for_each_entry(columns,
                       [&](const int row, const int other, const int entry)
                       {
                         if (row >= n_own)
                           return;
                         int place = next[row];
                         if (other < n_own)
                         {
                           while (column[place] != other) // passes what others alone couple
                             ++place;
                           next[row] = place + 1;
                         }
                         else
                           place = static_cast<int>(
                               std::lower_bound(column + place, column + start[row + 1], other)
                               - column);
                         value[place] = lower_values[entry];
                       });
      }

      void
      add_received(double *value) const
      {
        ByProcess<double> values;
        for (const auto &[process, entries] : foreign_entries)
          for (const int entry : entries)
            values[process].push_back(lower_values[entry]);
        values = dealii::Utilities::MPI::some_to_some(exchange.communicator(), values);
        for (const auto &[process, places] : places_of_received) // in the order of the processes
          for (std::size_t k = 0; k < places.size(); ++k)
            value[places[k]] += values[process][k];
      }

      const Exchange          &exchange;
      SymmetricPattern         pattern;
      std::vector<std::size_t> first_rows; ///< of each process, and the number of all rows
      int                      first_row = 0;
      std::vector<int> global_rows;     ///< of each free degree of freedom of this process' nodes
      std::vector<int> columns;         ///< of each, by local number
      std::vector<int> other_nodes;     ///< their first global rows, ascending
      ByProcess<int>   foreign_entries; ///< of lower_values that are parts of the rows of others
      ByProcess<int>   places_of_received; ///< of what others send, among the matrix' values
    };
  } // namespace

  std::unique_ptr<SpdOperator>
  make_distributed_operator(const FreeDofs &free_dofs, const double tolerance)
  {
    return std::make_unique<DistributedOperator>(free_dofs, tolerance);
  }
} // namespace Exemplar
