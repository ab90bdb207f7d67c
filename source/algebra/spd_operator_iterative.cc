// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/multigrid_operator.h>

#include <Epetra_MpiComm.h>
#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// In one process: the rows are those of the unknowns, in the same order.
    class IterativeOperator : public MultigridOperator
    {
    public:
      using MultigridOperator::MultigridOperator;

    private:
      void
      make_matrix(const SymmetricPattern &pattern) override
      {
        const std::size_t n_entries = 2 * pattern.row.size() - pattern.n() + n_rows() - pattern.n();
        check_size(n_entries);

        const std::vector<int> start   = row_starts(pattern);
        const std::vector<int> columns = columns_by_row(pattern, start);
        std::vector<int>       length(n_rows());
        for (unsigned int row = 0; row < n_rows(); ++row)
          length[row] = start[row + 1] - start[row];
        const std::vector<double> ones(n_rows(), 1.); // no row is longer
        const Epetra_Map          map(static_cast<int>(n_rows()), 0, Epetra_MpiComm(MPI_COMM_SELF));
        matrix = std::make_unique<Epetra_CrsMatrix>(Copy, map, map, length.data(), true);
        for (unsigned int row = 0; row < n_rows(); ++row)
          matrix->InsertMyValues(static_cast<int>(row), length[row], ones.data(),
                                 columns.data() + start[row]);
        matrix->FillComplete();
        matrix->OptimizeStorage();
      }

      std::vector<int>
      row_starts(const SymmetricPattern &pattern) const
      {
        std::vector<int> start(n_rows() + 1, 0);
        for (unsigned int i = 0; i < pattern.n(); ++i)
          for (int entry = pattern.column_start[i]; entry < pattern.column_start[i + 1]; ++entry)
          {
            ++start[row_of[i] + 1];
            if (pattern.row[entry] != static_cast<int>(i))
              ++start[row_of[pattern.row[entry]] + 1];
          }
        for (unsigned int row = 0; row < n_rows(); ++row)
          start[row + 1] = start[row] + std::max(start[row + 1], 1);
        return start;
      }

      /// Ascending in each row: a row of the lower triangle, then the diagonal and its column.
      std::vector<int>
      columns_by_row(const SymmetricPattern &pattern, const std::vector<int> &start) const
      {
        std::vector<int> columns(start.back()), next(start.begin(), start.end() - 1);
        for (unsigned int row = 0; row < n_rows(); ++row)
          columns[start[row]] = static_cast<int>(row); // of held components this remains
        for (unsigned int i = 0; i < pattern.n(); ++i)
          for (int entry = pattern.column_start[i]; entry < pattern.column_start[i + 1]; ++entry)
          {
            const int row              = row_of[pattern.row[entry]];
            columns[next[row_of[i]]++] = row;
            if (row != row_of[i])
              columns[next[row]++] = row_of[i];
          }
        return columns;
      }

      /// The lower triangle by columns to both triangles by rows.
      void
      fill_matrix() override
      {
        int    *start = nullptr, *column = nullptr;
        double *value = nullptr;
        matrix->ExtractCrsDataPointers(start, column, value);
        std::vector<int> next(start, start + n_rows()); // passes over the left part of a row
        const double    *lower = lower_values.data();
        for (const int row : row_of)
        {
          if (!(*lower > 0.)) // the diagonal
            throw indefinite_matrix();
          for (int entry = next[row]; entry < start[row + 1]; ++entry, ++lower)
          {
            value[entry] = *lower;
            if (column[entry] != row)
              value[next[column[entry]]++] = *lower;
          }
        }
      }
    };
  } // namespace

  bool
  has_iterative_operator()
  {
    return true;
  }

  std::unique_ptr<SpdOperator>
  make_iterative_operator(const FreeDofs &free_dofs, const double tolerance)
  {
    if (free_dofs.exchange().n_processes() > 1)
      return make_distributed_operator(free_dofs, tolerance);
    return std::make_unique<IterativeOperator>(free_dofs, tolerance);
  }
} // namespace Exemplar
