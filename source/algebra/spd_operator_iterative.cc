// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/mpi_session.h>
#include <exemplar/algebra/rigid_modes.h>
#include <exemplar/algebra/spd_operator.h>
#include <exemplar/base/errors.h>

#include <deal.II/lac/solver_cg.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Epetra_Vector.h>
#include <Teuchos_ParameterList.hpp>
#include <cmath>
#include <limits>
#include <malloc.h>
#include <ml_MultiLevelPreconditioner.h>
#include <ml_utils.h>
#include <mpi.h>
#include <numeric>
#include <string>

namespace Exemplar
{
  namespace
  {
    using Multigrid = ML_Epetra::MultiLevelPreconditioner;

    constexpr unsigned int max_iterations = 1000;

    /// Not deal.II's product of vectors, because that asserts in Debug that it is finite. Here it
    /// may be infinite or NaN, which check_curvature() and solve() report.
    double
    dot(const Vector &a, const Vector &b)
    {
      return std::inner_product(a.begin(), a.end(), b.begin(), 0.);
    }

    /// Throws unless x A x > 0: there conjugate gradients would go astray, and Newton's
    /// method wants to know.
    void
    check_curvature(const Vector &direction, const Vector &image)
    {
      if (!(dot(direction, image) > 0.)) // nor is a NaN
        throw indefinite_matrix();
    }

    /// A vector of deal.II as Epetra takes it.
    Epetra_Vector
    view(const Epetra_Map &map, const Vector &vector)
    {
      return Epetra_Vector(View, map, const_cast<double *>(vector.begin()));
    }

    /// What deal.II's solver multiplies with: the matrix, and the multigrid cycle.
    template <typename Multiply>
    class CheckedOperator
    {
    public:
      CheckedOperator(const Epetra_Map &map, const Multiply &multiply)
          : map(map), multiply(multiply)
      {
      }

      void
      vmult(Vector &image, const Vector &vector) const
      {
        Epetra_Vector result = view(map, image);
        multiply(view(map, vector), result);
        check_curvature(vector, image);
      }

    private:
      const Epetra_Map &map;
      const Multiply   &multiply;
    };

    /// Bytes that are allocated; ML does not tell what its hierarchies take.
    std::size_t
    heap_in_use()
    {
      const auto heap = mallinfo2();
      return heap.uordblks + heap.hblkhd;
    }

    /// The matrix has a block of three rows for every node that is not held as a whole, since
    /// ML takes the blocks for its graph. In the row of a held component is the unit matrix,
    /// and all vectors are zero there.
    class IterativeOperator : public SpdOperator
    {
    public:
      IterativeOperator(const FreeDofs &free_dofs, const double tolerance) : tolerance(tolerance)
      {
        for (const unsigned int dof : free_dofs.list())
        {
          if (nodes.empty() || nodes.back() != dof / 3)
            nodes.push_back(dof / 3);
          row_of.push_back(static_cast<int>(3 * (nodes.size() - 1) + dof % 3));
        }
        places.resize(3 * nodes.size());
        MpiSession::require();
      }

      OperatorTraits
      traits() const override
      {
        const std::size_t entries
            = matrix == nullptr ? 0 : static_cast<std::size_t>(matrix->NumMyNonzeros());
        return { "iterative", 0., 0.,
                 sizeof(double) * lower_values.size() + (sizeof(int) + sizeof(double)) * entries
                     + multigrid_memory };
      }

      void
      reinit(const SymmetricPattern &pattern) override
      {
        multigrid.reset();
        matrix.reset();
        lower_values.assign(pattern.n_values(), 0.);
        const std::size_t n_entries = 2 * pattern.row.size() - pattern.n() + n_rows() - pattern.n();
        if (n_entries > static_cast<std::size_t>(std::numeric_limits<int>::max()))
          throw SolverFailure("The matrix has more entries than Epetra can count. Use a coarser "
                              "mesh.");

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

      std::vector<double> &
      values() override
      {
        return lower_values;
      }

      void
      factorize(const Vector &positions) override
      {
        if (row_of.empty())
          return;
        place_nodes(positions);
        fill_matrix();
        // nothing takes as much memory as a hierarchy: give back what has been freed before
        multigrid.reset();
        malloc_trim(0);
        const std::size_t before = heap_in_use();

        const std::vector<double> modes = rigid_modes(places, row_of);
        Teuchos::ParameterList    parameters;
        ML_Epetra::SetDefaults("SA", parameters);
        parameters.set("ML output", 0);
        parameters.set("PDE equations", 3);
        parameters.set("null space: type", "pre-computed");
        parameters.set("null space: dimension", static_cast<int>(n_rigid_modes));
        parameters.set("null space: vectors", const_cast<double *>(modes.data()));
        parameters.set("aggregation: type", "Uncoupled");
        parameters.set("prec type", "MGW"); // W cycles: coarse levels cost next to nothing
        parameters.set("smoother: type", "Chebyshev");
        parameters.set("smoother: sweeps", 2);
        parameters.set("coarse: type", "Amesos-KLU");
        // of its eigenvalue estimates, or else they would depend on the hierarchies before
        ML_set_random_seed(1);
        multigrid = std::make_unique<Multigrid>(*matrix, parameters);
        if (!multigrid->IsPreconditionerComputed())
          throw SolverFailure("ML makes no multigrid hierarchy of the matrix of the step. Set "
                              "Solver/Linear solver to cholesky.");
        const std::size_t after = heap_in_use(); // a frame's writer may have freed memory since
        multigrid_memory        = after > before ? after - before : 0;
      }

      void
      solve(std::vector<double> &columns) override
      {
        const std::size_t n = row_of.size();
        Vector            right_side(n_rows()), solution(n_rows());
        for (std::size_t first = 0; first < columns.size(); first += n)
        {
          for (std::size_t i = 0; i < n; ++i)
            right_side[row_of[i]] = columns[first + i];
          solve(right_side, solution);
          for (std::size_t i = 0; i < n; ++i)
            columns[first + i] = solution[row_of[i]];
        }
      }

      std::unique_ptr<KeptInverse>
      keep() const override
      {
        throw SolverFailure("Solver/Linear solver = iterative makes no factor.");
      }

    private:
      unsigned int
      n_rows() const
      {
        return places.size();
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
      fill_matrix()
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

      void
      place_nodes(const Vector &positions)
      {
        for (std::size_t row = 0; row < places.size(); ++row)
          places[row] = positions[3 * nodes[row / 3] + row % 3];
        center_and_scale(places);
      }

      void
      solve(const Vector &right_side, Vector &solution) const
      {
        solution          = 0.;
        const double norm = std::sqrt(dot(right_side, right_side));
        if (norm == 0.)
          return;
        if (!std::isfinite(norm))
          throw SolverFailure("The forces are not finite numbers.");
        const auto multiply
            = [this](const Epetra_Vector &x, Epetra_Vector &y) { matrix->Multiply(false, x, y); };
        const auto cycle
            = [this](const Epetra_Vector &x, Epetra_Vector &y) { multigrid->ApplyInverse(x, y); };
        dealii::SolverControl                 control(max_iterations, tolerance * norm);
        dealii::PrimitiveVectorMemory<Vector> memory;
        try
        {
          dealii::SolverCG<Vector>(control, memory)
              .solve(CheckedOperator(matrix->RowMap(), multiply), solution, right_side,
                     CheckedOperator(matrix->RowMap(), cycle));
        }
        catch (const dealii::SolverControl::NoConvergence &)
        {
          throw SolverFailure(
              "The conjugate gradients do not converge in " + std::to_string(max_iterations)
              + " iterations. Flat cells and a Poisson's ratio near 0.5 make them slow: set "
                "Solver/Linear solver to cholesky, or improve the mesh.");
        }
      }

      const double                      tolerance;
      std::vector<unsigned int>         nodes;  ///< those with rows
      std::vector<int>                  row_of; ///< of each free degree of freedom
      std::vector<double>               places; ///< of the nodes, by row
      std::vector<double>               lower_values;
      std::unique_ptr<Epetra_CrsMatrix> matrix;
      std::unique_ptr<Multigrid>        multigrid;
      std::size_t multigrid_memory = 0; ///< what its making has left on the heap [bytes]
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
    return std::make_unique<IterativeOperator>(free_dofs, tolerance);
  }
} // namespace Exemplar
