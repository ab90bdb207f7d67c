// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/algebra/multigrid_inverse.h>
#include <exemplar/algebra/multigrid_operator.h>
#include <exemplar/algebra/rigid_modes.h>
#include <exemplar/algebra/trilinos_lock.h>
#include <exemplar/base/mpi_session.h>

#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/vector_memory.templates.h> // for vectors that are not deal.II's

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <malloc.h>
#include <numeric>
#include <string>

namespace Exemplar
{
  /// The owned rows of a distributed vector, for deal.II's solver: scalar products are sums over
  /// all processes.
  class SharedVector : public Vector
  {
  public:
    SharedVector() = default;

    /// Without rows the vector has one entry of zero: deal.II asserts in Debug that vectors are not
    /// empty.
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

    /// Scalar product. deal.II's asserts in Debug that it is finite; here it may be infinite or
    /// NaN, which check_curvature() and solve() report.
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

    /// What a hierarchy costs in conjugate gradients with it, by measurement on a million cells.
    constexpr unsigned int hierarchy_in_iterations = 40;

    /// Throws unless x^T A x > 0: otherwise conjugate gradients would diverge, and Newton's method
    /// has to know.
    void
    check_curvature(const SharedVector &direction, const SharedVector &image)
    {
      if (!(direction.dot(image) > 0.)) // false for a NaN, too
        throw indefinite_matrix();
    }

    /// Adapter for deal.II's solver: the matrix, and the multigrid cycle.
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

    /// Outer products renumbered from nodes to global block rows, without held components.
    OuterProducts
    by_rows(const OuterProducts &products, const FreeDofs &free_dofs, const RowNumbers &numbers)
    {
      constexpr unsigned int    none = -1;
      std::vector<unsigned int> block_of(free_dofs.n_dofs() / 3, none);
      for (std::size_t i = 0; i < free_dofs.local_list().size(); ++i)
        block_of[free_dofs.local_list()[i] / 3] = numbers.global_rows()[i] / 3;
      OuterProducts result;
      for (std::size_t product = 0; product < products.size(); ++product)
      {
        for (std::size_t k = products.begin(product); k < products.ends[product]; ++k)
        {
          const unsigned int node = products.blocks[k];
          if (block_of[node] == none)
            continue;
          result.blocks.push_back(block_of[node]);
          for (unsigned int c = 0; c < 3; ++c)
            result.values.push_back(free_dofs.free_index(3 * node + c) == FreeDofs::held
                                        ? 0.
                                        : products.values[3 * k + c]);
        }
        result.factors.push_back(products.factors[product]);
        result.ends.push_back(result.blocks.size());
      }
      return result;
    }

    /// The diagonal of a sum of outer products, by owned row.
    std::vector<double>
    diagonal_of(const OuterProductRows<double> &products, const std::size_t n_rows)
    {
      std::vector<double> diagonal(n_rows, 0.);
      for (std::size_t row = 0; row < n_rows; row += 3)
        products.for_each_in_row(row / 3,
                                 [&](const int product, const double *u)
                                 {
                                   for (unsigned int c = 0; c < 3; ++c)
                                     diagonal[row + c] += products.factor(product) * u[c] * u[c];
                                 });
      return diagonal;
    }
  } // namespace

  MultigridOperator::MultigridOperator(const FreeDofs           &free_dofs,
                                       const double              tolerance,
                                       std::vector<unsigned int> pieces,
                                       MakeHierarchy             make_hierarchy)
      : free_dofs(free_dofs), tolerance(tolerance), pieces(std::move(pieces)),
        make_hierarchy(std::move(make_hierarchy)), rows(free_dofs)
  {
    MpiSession::require();
  }

  OperatorTraits
  MultigridOperator::traits() const
  {
    return { "iterative", 0., 0.,
             sizeof(double) * (lower_values.size() + products.values.size())
                 + rows.memory_consumption() + product_rows.memory_consumption()
                 + (cycle == nullptr ? 0 : cycle->memory_consumption()) };
  }

  void
  MultigridOperator::reinit(const SymmetricPattern &pattern)
  {
    cycle.reset();
    is_of_earlier = false;
    products.clear();
    lower_values.assign(pattern.n_values(), 0.);
    const TrilinosLock lock; // calls MPI
    rows.reinit(pattern);
  }

  void
  MultigridOperator::factorize(const Vector &positions)
  {
    if (rows.get_numbers().first_nodes().back() == 0)
      return;
    make_cycle(take_matrix(positions));
  }

  void
  MultigridOperator::factorize_near(const Vector &positions)
  {
    if (cycle == nullptr)
      return factorize(positions);
    take_matrix(positions);
    is_of_earlier = true;
  }

  OuterProducts
  MultigridOperator::take_matrix(const Vector &positions)
  {
    const RowNumbers  &numbers = rows.get_numbers();
    const TrilinosLock lock; // calls MPI
    OuterProducts      of_rows = by_rows(products, free_dofs, numbers);
    places                     = places_of_nodes(positions);
    product_rows = OuterProductRows<double>(of_rows, numbers.first_nodes(), free_dofs.exchange());
    rows.fill(lower_values, diagonal_of(product_rows, numbers.n_rows()));
    find_rigid_correction();
    return of_rows;
  }

  void
  MultigridOperator::find_rigid_correction()
  {
    if (!free_dofs.exchange().any(!pieces.empty()))
      return;
    std::vector<unsigned int> of_rows;
    for (const unsigned int node : rows.get_numbers().nodes())
      of_rows.push_back(pieces[node]);
    rigid = RigidCorrection(
        places, of_rows, rows.get_numbers().row_of(),
        [this](const Vector &x, Vector &y) { multiply(x, y); }, free_dofs.exchange());
  }

  void
  MultigridOperator::make_cycle(const OuterProducts &of_rows)
  {
    const RowNumbers &numbers = rows.get_numbers();
    // nothing takes as much memory as a hierarchy: give back what has been freed before
    cycle.reset();
    malloc_trim(0);
    const TrilinosLock          lock; // calls MPI
    std::vector<MultigridLevel> levels
        = make_hierarchy(rows, rigid_modes(places, numbers.row_of()));
    add_products(of_rows, levels, free_dofs.exchange());
    cycle         = std::make_shared<MultigridCycle>(std::move(levels), free_dofs.exchange());
    is_of_earlier = false;
    n_iterations  = 0;
  }

  void
  MultigridOperator::solve(std::vector<double> &columns, const double accuracy)
  {
    const RowNumbers       &numbers = rows.get_numbers();
    const std::vector<int> &row_of  = numbers.row_of();
    const std::size_t       n       = row_of.size();
    // a process without unknowns does not know how many there are
    const auto n_columns = static_cast<std::size_t>(
        free_dofs.exchange().max(n == 0 ? 0. : static_cast<double>(columns.size() / n)));
    SharedVector right_side(numbers.n_rows(), free_dofs.exchange()), solution(right_side);
    for (std::size_t column = 0; column < n_columns; ++column)
    {
      double *entries = columns.data() + column * n;
      for (std::size_t i = 0; i < n; ++i)
        right_side[row_of[i]] = entries[i];
      solve(std::max(accuracy, tolerance), right_side, solution);
      for (std::size_t i = 0; i < n; ++i)
        entries[i] = solution[row_of[i]];
    }
  }

  std::unique_ptr<KeptInverse>
  MultigridOperator::keep() const
  {
    return std::make_unique<MultigridInverse>(cycle, rows.get_numbers().row_of(),
                                              free_dofs.exchange());
  }

  std::vector<double>
  MultigridOperator::places_of_nodes(const Vector &positions) const
  {
    std::vector<double> places;
    for (const unsigned int node : rows.get_numbers().nodes())
      places.insert(places.end(), positions.begin() + 3 * node, positions.begin() + 3 * node + 3);
    center_and_scale(places, free_dofs.exchange());
    return places;
  }

  void
  MultigridOperator::multiply(const Vector &vector, Vector &image) const
  {
    rows.multiply(vector, image);
    const std::vector<double> coefficients = product_rows.coefficients(vector.begin());
    for (unsigned int row = 0; row < rows.get_numbers().n_rows(); row += 3)
      product_rows.for_each_in_row(row / 3,
                                   [&](const int product, const double *u)
                                   {
                                     for (unsigned int c = 0; c < 3; ++c)
                                       image[row + c] += coefficients[product] * u[c];
                                   });
  }

  void
  MultigridOperator::precondition(const Vector &vector, Vector &image) const
  {
    // scaled: residuals that shrink by ten orders of magnitude would underflow in single precision
    const unsigned int n  = rows.get_numbers().n_rows();
    const double scale    = free_dofs.exchange().max(max_entry(vector.begin(), vector.begin() + n));
    BlockVector  residual = cycle->matrix().zeros();
    for (unsigned int row = 0; row < n && scale > 0.; ++row)
      residual[4 * (row / 3) + row % 3] = static_cast<float>(vector[row] / scale);
    const BlockVector &result = cycle->apply(residual, CycleShape::W);
    for (unsigned int row = 0; row < n; ++row)
      image[row] = scale * result[4 * (row / 3) + row % 3];
    if (!rigid.empty())
      rigid.add(vector, image);
  }

  unsigned int
  MultigridOperator::iterate(const SharedVector &right_side,
                             const double        residual,
                             const unsigned int  limit,
                             SharedVector       &solution) const
  {
    const auto            A        = [this](const Vector &x, Vector &y) { multiply(x, y); };
    const auto            inverse  = [this](const Vector &x, Vector &y) { precondition(x, y); };
    const bool            has_rows = rows.get_numbers().n_rows() > 0;
    dealii::SolverControl control(limit, residual);
    dealii::PrimitiveVectorMemory<SharedVector> memory;
    try
    {
      dealii::SolverCG<SharedVector>(control, memory)
          .solve(CheckedOperator(A, has_rows), solution, right_side,
                 CheckedOperator(inverse, has_rows));
    }
    catch (const dealii::SolverControl::NoConvergence &)
    {
      return limit + 1;
    }
    return control.last_step();
  }

  void
  MultigridOperator::solve(const double        accuracy,
                           const SharedVector &right_side,
                           SharedVector       &solution)
  {
    solution          = 0.;
    const double norm = std::sqrt(right_side.dot(right_side));
    if (norm == 0.)
      return;
    if (!std::isfinite(norm))
      throw SolverFailure("The forces are not finite numbers.");
    if (is_of_earlier)
    {
      const unsigned int allowed = n_iterations + hierarchy_in_iterations;
      if (iterate(right_side, accuracy * norm, allowed, solution) <= allowed)
        return correct_rigid_motions(right_side, solution);
      make_cycle(by_rows(products, free_dofs, rows.get_numbers()));
    }
    const unsigned int needed = iterate(right_side, accuracy * norm, max_iterations, solution);
    if (needed > max_iterations)
      throw SolverFailure(fmt::format("The conjugate gradients do not converge in {} iterations. "
                                      "Flat cells and a Poisson's ratio near 0.5 make them slow: "
                                      "set Solver/Linear solver to cholesky, or improve the mesh.",
                                      max_iterations));
    if (n_iterations == 0)
      n_iterations = needed;
    correct_rigid_motions(right_side, solution);
  }

  void
  MultigridOperator::correct_rigid_motions(const SharedVector &right_side,
                                           SharedVector       &solution) const
  {
    // what the residual leaves of a weak constraint's small force is a large motion
    if (rigid.empty())
      return;
    SharedVector residual(right_side);
    multiply(solution, residual);
    residual.sadd(-1., 1., right_side);
    rigid.add(residual, solution);
  }
} // namespace Exemplar
