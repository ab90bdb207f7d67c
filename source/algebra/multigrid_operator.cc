// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/multigrid_inverse.h>
#include <exemplar/algebra/multigrid_operator.h>
#include <exemplar/algebra/rigid_modes.h>
#include <exemplar/algebra/trilinos_lock.h>
#include <exemplar/base/mpi_session.h>

#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/vector_memory.templates.h> // for vectors that are not deal.II's

#include <algorithm>
#include <cmath>
#include <malloc.h>
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
      return std::sqrt(exchange->sum(norm_sqr()));
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
    constexpr unsigned int max_iterations = 1000;

    /// Throws unless x A x > 0: there conjugate gradients would go astray, and Newton's
    /// method wants to know.
    void
    check_curvature(const SharedVector &direction, const SharedVector &image)
    {
      if (!(direction.dot(image) > 0.)) // nor is a NaN
        throw indefinite_matrix();
    }

    /// What deal.II's solver multiplies with: the matrix, and the multigrid cycle.
    template <typename Multiply>
    class CheckedOperator
    {
    public:
      CheckedOperator(const Multiply &multiply, const bool has_rows)
          : multiply(multiply), has_rows(has_rows)
      {
      }

      void
      vmult(SharedVector &image, const SharedVector &vector) const
      {
        if (!has_rows)
          image = 0.;
        multiply(vector, image);
        check_curvature(vector, image);
      }

    private:
      const Multiply &multiply;
      const bool      has_rows;
    };

    /// Bytes that are allocated; libraries do not tell what their hierarchies take.
    std::size_t
    heap_in_use()
    {
      const auto heap = mallinfo2();
      return heap.uordblks + heap.hblkhd;
    }
  } // namespace

  MultigridOperator::MultigridOperator(const FreeDofs &free_dofs,
                                       const double    tolerance,
                                       MakeHierarchy   make_hierarchy)
      : exchange(free_dofs.exchange()), tolerance(tolerance),
        make_hierarchy(std::move(make_hierarchy)), rows(free_dofs)
  {
    MpiSession::require();
  }

  OperatorTraits
  MultigridOperator::traits() const
  {
    return { "iterative", 0., 0.,
             sizeof(double) * lower_values.size() + rows.memory_consumption() + multigrid_memory };
  }

  void
  MultigridOperator::reinit(const SymmetricPattern &pattern)
  {
    hierarchy.reset();
    lower_values.assign(pattern.n_values(), 0.);
    {
      const TrilinosLock lock; // calls MPI
      rows.reinit(pattern);
    }
    hierarchy = make_hierarchy(rows);
  }

  void
  MultigridOperator::factorize(const Vector &positions)
  {
    const RowNumbers &numbers = rows.get_numbers();
    if (numbers.first_nodes().back() == 0)
      return;
    std::vector<double> modes = rigid_modes(places_of_nodes(positions), numbers.row_of());
    {
      const TrilinosLock lock; // calls MPI
      rows.fill(lower_values);
    }
    // nothing takes as much memory as a hierarchy: give back what has been freed before
    hierarchy->clear();
    malloc_trim(0);
    const std::size_t before = heap_in_use();
    hierarchy->make(std::move(modes));
    const std::size_t after = heap_in_use(); // a frame's writer may have freed memory since
    multigrid_memory        = after > before ? after - before : 0;
  }

  void
  MultigridOperator::solve(std::vector<double> &columns)
  {
    const RowNumbers       &numbers = rows.get_numbers();
    const std::vector<int> &row_of  = numbers.row_of();
    const std::size_t       n       = row_of.size();
    // a process without unknowns does not know how many there are
    const auto n_columns = static_cast<std::size_t>(
        exchange.max(n == 0 ? 0. : static_cast<double>(columns.size() / n)));
    SharedVector right_side(numbers.n_rows(), exchange), solution(numbers.n_rows(), exchange);
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
    return std::make_unique<MultigridInverse>(hierarchy->copy(), rows.get_numbers().row_of(),
                                              exchange);
  }

  std::vector<double>
  MultigridOperator::places_of_nodes(const Vector &positions) const
  {
    std::vector<double> places;
    for (const unsigned int node : rows.get_numbers().nodes())
      places.insert(places.end(), positions.begin() + 3 * node, positions.begin() + 3 * node + 3);
    center_and_scale(places, exchange);
    return places;
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
    const auto            multiply = [this](const Vector &x, Vector &y) { rows.multiply(x, y); };
    const auto            cycle    = [this](const Vector &x, Vector &y) { hierarchy->apply(x, y); };
    const bool            has_rows = rows.get_numbers().n_rows() > 0;
    dealii::SolverControl control(max_iterations, tolerance * norm);
    dealii::PrimitiveVectorMemory<SharedVector> memory;
    try
    {
      dealii::SolverCG<SharedVector>(control, memory)
          .solve(CheckedOperator(multiply, has_rows), solution, right_side,
                 CheckedOperator(cycle, has_rows));
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
