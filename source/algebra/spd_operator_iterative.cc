// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/multigrid_operator.h>
#include <exemplar/algebra/rigid_modes.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Teuchos_ParameterList.hpp>
#include <ml_MultiLevelPreconditioner.h>
#include <ml_include.h>
#include <ml_struct.h>
#include <ml_utils.h>
#include <mpi.h>

// All uses of Trilinos: Epetra's view of rows, and ML's levels.

namespace Exemplar
{
  namespace
  {
    /// Epetra's view of rows.
    std::unique_ptr<Epetra_CrsMatrix>
    view(DistributedRows &rows)
    {
      CsrMatrix             &csr    = rows.get_matrix();
      const int              n_rows = static_cast<int>(rows.get_numbers().n_rows());
      const std::vector<int> all    = rows.global_columns();
      const Epetra_MpiComm   communicator(rows.get_numbers().exchange().communicator());
      const Epetra_Map       row_map(-1, n_rows, 0, communicator);
      const Epetra_Map column_map(-1, static_cast<int>(all.size()), all.data(), 0, communicator);
      csr.column.reserve(1); // Epetra wants an address even without rows
      csr.value.reserve(1);
      // the constructor for a complete matrix: every other would copy the columns
      auto matrix = std::make_unique<Epetra_CrsMatrix>(View, row_map, column_map, 0, true);
      matrix->ExpertExtractIndexOffset().MakeViewOf({ View, csr.row_start.data(), n_rows + 1 });
      matrix->ExpertExtractIndices().MakeViewOf(
          { View, csr.column.data(), static_cast<int>(csr.column.size()) });
      matrix->ExpertExtractValues() = csr.value.data();
      matrix->ExpertStaticFillComplete(row_map, row_map);
      return matrix;
    }

    /// Global numbers of the columns of an ML matrix, whose owned columns count from `first` on.
    std::vector<std::size_t>
    global_columns(ML_Operator *matrix, const std::size_t first)
    {
      const int n_own = matrix->invec_leng;
      int       n_all = n_own;
      if (ML_CommInfoOP *with = matrix->getrow->pre_comm)
      {
        ML_CommInfoOP_Compute_TotalRcvLength(with);
        n_all += with->total_rcv_length;
      }
      std::vector<double> numbers(n_all);
      for (int i = 0; i < n_own; ++i)
        numbers[i] = static_cast<double>(first + i);
      if (matrix->getrow->pre_comm != nullptr)
        ML_exchange_bdry(numbers.data(), matrix->getrow->pre_comm, n_own, matrix->comm,
                         ML_OVERWRITE, nullptr);
      return { numbers.begin(), numbers.end() };
    }

    BlockMatrix
    copy_in_blocks(ML_Operator *matrix, const Exchange &exchange)
    {
      const std::vector<std::size_t> firsts = first_numbers(matrix->invec_leng / 3, exchange);
      const auto                     read_row
          = [matrix](const int row, std::vector<int> &columns, std::vector<double> &values)
      {
        int length = 0, number = row;
        while (ML_Operator_Getrow(matrix, 1, &number, static_cast<int>(columns.size()),
                                  columns.data(), values.data(), &length)
               == 0)
        {
          columns.resize(2 * columns.size() + 1);
          values.resize(columns.size());
        }
        return length;
      };
      return make_block_matrix(matrix->outvec_leng / 3, firsts,
                               global_columns(matrix, 3 * firsts[exchange.process()]), read_row,
                               exchange);
    }

    std::vector<MultigridLevel>
    copy_levels(const ML_Struct &ml, const Exchange &exchange)
    {
      const int                   down = ml.ML_finest_level < ml.ML_coarsest_level ? 1 : -1;
      std::vector<MultigridLevel> levels;
      for (int number = ml.ML_finest_level; number != ml.ML_coarsest_level; number += down)
      {
        BlockMatrix of_level = copy_in_blocks(&ml.Amat[number], exchange);
        levels.push_back(
            { std::move(of_level), copy_in_blocks(&ml.Pmat[number + down], exchange) });
      }
      levels.push_back(
          { copy_in_blocks(&ml.Amat[ml.ML_coarsest_level], exchange), BlockMatrix(Halo()) });
      return levels;
    }

    /// Levels by ML's smoothed aggregation; the cycle on them is ours.
    std::vector<MultigridLevel>
    make_by_ml(DistributedRows &rows, std::vector<double> modes)
    {
      const Exchange                         &exchange = rows.get_numbers().exchange();
      const std::unique_ptr<Epetra_CrsMatrix> matrix   = view(rows);
      modes.reserve(1); // ML wants an address even without rows
      Teuchos::ParameterList parameters;
      ML_Epetra::SetDefaults("SA", parameters);
      parameters.set("ML output", 0);
      parameters.set("PDE equations", 3);
      parameters.set("null space: type", "pre-computed");
      parameters.set("null space: dimension", static_cast<int>(n_rigid_modes));
      parameters.set("null space: vectors", modes.data());
      parameters.set("aggregation: type", "Uncoupled");
      parameters.set("smoother: type", "do-nothing");
      parameters.set("coarse: type", "do-nothing");
      // seeds ML's eigenvalue estimates, which would otherwise depend on earlier hierarchies
      ML_set_random_seed(1);
      const ML_Epetra::MultiLevelPreconditioner multigrid(*matrix, parameters);
      if (exchange.any(!multigrid.IsPreconditionerComputed()))
        throw SolverFailure("ML makes no multigrid hierarchy of the matrix of the step. Set "
                            "Solver/Linear solver to cholesky.");
      return copy_levels(*multigrid.GetML(), exchange);
    }
  } // namespace

  bool
  has_iterative_operator()
  {
    return true;
  }

  std::unique_ptr<SpdOperator>
  make_iterative_operator(const FreeDofs           &free_dofs,
                          const double              tolerance,
                          std::vector<unsigned int> pieces)
  {
    return std::make_unique<MultigridOperator>(free_dofs, tolerance, std::move(pieces), make_by_ml);
  }
} // namespace Exemplar
