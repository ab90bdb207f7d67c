// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/mpi_session.h>
#include <exemplar/algebra/multigrid_inverse.h>
#include <exemplar/algebra/multigrid_operator.h>
#include <exemplar/algebra/rigid_modes.h>
#include <exemplar/algebra/trilinos_lock.h>

#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/vector_memory.templates.h> // for vectors that are not deal.II's

#include <Epetra_Vector.h>
#include <Teuchos_ParameterList.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <malloc.h>
#include <ml_utils.h>
#include <numeric>
#include <string>

namespace Exemplar
{
  /// The rows that a process has of a vector, as deal.II's solver takes them: its products are
  /// sums over all processes.
  class SharedVector : public Vector
  {
  public:
    SharedVector() = default;

    /// Where there are no rows, an entry of zero stands for them: deal.II asserts in Debug that
    /// vectors are not empty.
    SharedVector(const unsigned int n, const Exchange &exchange)
        : Vector(std::max(n, 1U)), exchange(&exchange)
    {
    }

    using Vector::operator=;

    void
    reinit(const SharedVector &like, const bool leave_values)
    {
      exchange = like.exchange;
      Vector::reinit(like, leave_values);
    }

    double
    operator*(const SharedVector &other) const
    {
      return exchange->sum(Vector::operator*(other));
    }

    double
    l2_norm() const
    {
      return exchange->n_processes() == 1 ? Vector::l2_norm()
                                          : std::sqrt(exchange->sum(norm_sqr()));
    }

    double
    add_and_dot(const double factor, const SharedVector &v, const SharedVector &w)
    {
      return exchange->sum(Vector::add_and_dot(factor, v, w));
    }

    /// Not deal.II's product, because that asserts in Debug that it is finite. Here it may be
    /// infinite or NaN, which check_curvature() and solve() report.
    double
    dot(const SharedVector &other) const
    {
      return exchange->sum(std::inner_product(begin(), end(), other.begin(), 0.));
    }

  private:
    const Exchange *exchange = nullptr;
  };

  namespace
  {
    using Multigrid = ML_Epetra::MultiLevelPreconditioner;

    constexpr unsigned int max_iterations = 1000;

    /// Throws unless x A x > 0: there conjugate gradients would go astray, and Newton's
    /// method wants to know.
    void
    check_curvature(const SharedVector &direction, const SharedVector &image)
    {
      if (!(direction.dot(image) > 0.)) // nor is a NaN
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
      vmult(SharedVector &image, const SharedVector &vector) const
      {
        if (map.NumMyElements() == 0)
          image = 0.;
        {
          const TrilinosLock lock; // Epetra's product starts a timer of the process
          Epetra_Vector      result = view(map, image);
          multiply(view(map, vector), result);
        }
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
  } // namespace

  MultigridOperator::MultigridOperator(const FreeDofs &free_dofs, const double tolerance)
      : free_dofs(free_dofs), tolerance(tolerance)
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
  MultigridOperator::traits() const
  {
    const std::size_t entries
        = matrix == nullptr ? 0 : static_cast<std::size_t>(matrix->NumMyNonzeros());
    return { "iterative", 0., 0.,
             sizeof(double) * lower_values.size() + (sizeof(int) + sizeof(double)) * entries
                 + multigrid_memory };
  }

  void
  MultigridOperator::check_size(const std::size_t n_entries) const
  {
    if (free_dofs.exchange().any(n_entries
                                 > static_cast<std::size_t>(std::numeric_limits<int>::max())))
      throw SolverFailure("The matrix has more entries than Epetra can count. Use a coarser "
                          "mesh.");
  }

  MultigridOperator::~MultigridOperator()
  {
    const TrilinosLock lock;
    multigrid.reset(); // refers to the matrix
    matrix.reset();
  }

  void
  MultigridOperator::reinit(const SymmetricPattern &pattern)
  {
    const TrilinosLock lock;
    multigrid.reset();
    matrix.reset();
    lower_values.assign(pattern.n_values(), 0.);
    make_matrix(pattern);
  }

  void
  MultigridOperator::factorize(const Vector &positions)
  {
    if (!free_dofs.exchange().any(!row_of.empty()))
      return;
    place_nodes(positions);
    fill_matrix();
    const TrilinosLock lock;
    // nothing takes as much memory as a hierarchy: give back what has been freed before
    multigrid.reset();
    malloc_trim(0);
    const std::size_t before = heap_in_use();
    make_multigrid();
    const std::size_t after = heap_in_use(); // a frame's writer may have freed memory since
    multigrid_memory        = after > before ? after - before : 0;
  }

  void
  MultigridOperator::make_multigrid()
  {
    std::vector<double> modes = rigid_modes(places, row_of);
    modes.reserve(1); // where there are no rows, too, ML wants an address
    Teuchos::ParameterList parameters;
    ML_Epetra::SetDefaults("SA", parameters);
    parameters.set("ML output", 0);
    parameters.set("PDE equations", 3);
    parameters.set("null space: type", "pre-computed");
    parameters.set("null space: dimension", static_cast<int>(n_rigid_modes));
    parameters.set("null space: vectors", modes.data());
    parameters.set("aggregation: type", "Uncoupled");
    parameters.set("prec type", "MGW"); // W cycles: coarse levels cost next to nothing
    parameters.set("smoother: type", "Chebyshev");
    parameters.set("smoother: sweeps", 2);
    parameters.set("coarse: type", "Amesos-KLU");
    // of its eigenvalue estimates, or else they would depend on the hierarchies before
    ML_set_random_seed(1);
    multigrid = std::make_unique<Multigrid>(*matrix, parameters);
    if (free_dofs.exchange().any(!multigrid->IsPreconditionerComputed()))
      throw SolverFailure("ML makes no multigrid hierarchy of the matrix of the step. Set "
                          "Solver/Linear solver to cholesky.");
  }

  void
  MultigridOperator::solve(std::vector<double> &columns)
  {
    const Exchange   &exchange = free_dofs.exchange();
    const std::size_t n        = row_of.size();
    // a process without unknowns does not know how many there are
    const auto n_columns = static_cast<std::size_t>(
        exchange.max(n == 0 ? 0. : static_cast<double>(columns.size() / n)));
    SharedVector right_side(n_rows(), exchange), solution(n_rows(), exchange);
    for (std::size_t column = 0; column < n_columns; ++column)
    {
      double *entries = columns.data() + column * n;
      for (std::size_t i = 0; i < n; ++i)
        right_side[row_of[i]] = entries[i];
      solve(right_side, solution);
      for (std::size_t i = 0; i < n; ++i)
        entries[i] = solution[row_of[i]];
    }
  }

  std::unique_ptr<KeptInverse>
  MultigridOperator::keep() const
  {
    return std::make_unique<MultigridInverse>(*multigrid->GetML(), row_of, free_dofs.exchange());
  }

  void
  MultigridOperator::place_nodes(const Vector &positions)
  {
    for (std::size_t row = 0; row < places.size(); ++row)
      places[row] = positions[3 * nodes[row / 3] + row % 3];
    center_and_scale(places, free_dofs.exchange());
  }

  void
  MultigridOperator::solve(const SharedVector &right_side, SharedVector &solution) const
  {
    solution          = 0.;
    const double norm = std::sqrt(right_side.dot(right_side));
    if (norm == 0.)
      return;
    if (!std::isfinite(norm))
      throw SolverFailure("The forces are not finite numbers.");
    const auto multiply
        = [this](const Epetra_Vector &x, Epetra_Vector &y) { matrix->Multiply(false, x, y); };
    const auto cycle
        = [this](const Epetra_Vector &x, Epetra_Vector &y) { multigrid->ApplyInverse(x, y); };
    dealii::SolverControl                       control(max_iterations, tolerance * norm);
    dealii::PrimitiveVectorMemory<SharedVector> memory;
    try
    {
      dealii::SolverCG<SharedVector>(control, memory)
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
} // namespace Exemplar
