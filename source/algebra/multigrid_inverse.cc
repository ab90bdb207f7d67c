// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/exchange.h>
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/algebra/multigrid_inverse.h>
#include <exemplar/algebra/trilinos_lock.h>

#include <deal.II/base/tensor.h>
#include <deal.II/lac/tridiagonal_matrix.h>

#include <algorithm>
#include <cmath>
#include <ml_include.h>
#include <ml_struct.h>

namespace Exemplar
{
  namespace
  {
    // chosen by measurement, doc/speed.md
    constexpr unsigned int smoother_degree = 2;
    constexpr double       smoother_range  = 20.; ///< greatest over least eigenvalue that it damps
    constexpr double       cycles_leave    = 0.3; ///< of an error, at most
    constexpr unsigned int max_cycles      = 10;
    constexpr unsigned int n_lanczos_steps = 8;
    constexpr double greatest_is_above = 1.1, cycle_is_above = 1.05; ///< what Lanczos' method finds

    /// The factors of Chebyshev's iteration for eigenvalues between two numbers: a step is `keep`
    /// times the last and `take` times the preconditioned residual.
    class ChebyshevFactors
    {
    public:
      ChebyshevFactors(const double least, const double greatest)
          : center(0.5 * (greatest + least)), radius(0.5 * (greatest - least)),
            rho(radius / center), take(1. / center)
      {
      }

      void
      advance()
      {
        const double next = 1. / (2. * center / radius - rho);
        keep              = next * rho;
        take              = 2. * next / radius;
        rho               = next;
      }

    private:
      double center, radius, rho;

    public:
      double keep = 0., take;
    };

    /// How many steps of Chebyshev's iteration leave little enough of an error.
    unsigned int
    find_n_cycles(const double condition)
    {
      const double root = std::sqrt(condition), rate = (root - 1.) / (root + 1.);
      unsigned int n = 1;
      for (double left = rate; n < max_cycles && 2. * left / (1. + left * left) > cycles_leave;
           left *= rate)
        ++n;
      return n;
    }

    /// Numbers among all processes of the columns of a matrix, of which the own begin with `first`.
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

    /// Of each process the number of the first of the things of which this one has `n_own`, and the
    /// number of all.
    std::vector<std::size_t>
    first_numbers(const std::size_t n_own, const Exchange &exchange)
    {
      std::vector<std::size_t> firsts{ 0 };
      for (const std::size_t n : exchange.collect({ n_own }))
        firsts.push_back(firsts.back() + n);
      return firsts;
    }

    /// Four numbers a block, for those that a process owns and `others`.
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner>
    make_partitioner(const std::vector<std::size_t> &firsts,
                     const std::vector<std::size_t> &others,
                     const Exchange                 &exchange)
    {
      if (exchange.n_processes() == 1)
        return nullptr;
      dealii::IndexSet own(4 * firsts.back()), ghosts(4 * firsts.back());
      own.add_range(4 * firsts[exchange.process()], 4 * firsts[exchange.process() + 1]);
      for (const std::size_t block : others)
        ghosts.add_range(4 * block, 4 * (block + 1));
      own.compress();
      ghosts.compress();
      return std::make_shared<const dealii::Utilities::MPI::Partitioner>(
          own, ghosts, exchange.communicator());
    }

    BlockMatrix
    copy_in_blocks(ML_Operator *matrix, const Exchange &exchange)
    {
      const TrilinosLock             lock;
      const int                      n_own  = matrix->invec_leng / 3;
      const std::vector<std::size_t> firsts = first_numbers(n_own, exchange);
      const std::vector<std::size_t> numbers
          = global_columns(matrix, 3 * firsts[exchange.process()]);
      std::vector<std::size_t> others;
      for (std::size_t column = matrix->invec_leng; column < numbers.size(); ++column)
        others.push_back(numbers[column] / 3);
      std::sort(others.begin(), others.end());
      others.erase(std::unique(others.begin(), others.end()), others.end());
      std::vector<int> blocks(numbers.size());
      for (std::size_t column = 0; column < numbers.size(); ++column)
        blocks[column] = static_cast<int>(column) < matrix->invec_leng
                             ? static_cast<int>(column / 3)
                             : n_own
                                   + static_cast<int>(std::lower_bound(others.begin(), others.end(),
                                                                       numbers[column] / 3)
                                                      - others.begin());

      BlockMatrix         result(n_own, others.size(), make_partitioner(firsts, others, exchange));
      std::vector<int>    columns(1000);
      std::vector<double> values(1000);
      std::vector<BlockMatrix::Entry> entries;
      for (int row = 0; row < matrix->outvec_leng; ++row)
      {
        int length = 0;
        while (ML_Operator_Getrow(matrix, 1, &row, static_cast<int>(columns.size()), columns.data(),
                                  values.data(), &length)
               == 0)
        {
          columns.resize(2 * columns.size());
          values.resize(columns.size());
        }
        for (int k = 0; k < length; ++k)
          entries.push_back({ blocks[columns[k]],
                              static_cast<int>(3 * (numbers[columns[k]] % 3)) + row % 3,
                              static_cast<float>(values[k]) });
        if (row % 3 == 2)
        {
          result.add_row(entries);
          entries.clear();
        }
      }
      result.finish();
      return result;
    }

    /// The inverses of the blocks of the diagonal, by columns; of their diagonals, where they are
    /// singular, as they are where an aggregate has too few nodes to turn.
    std::vector<float>
    invert_diagonal(const BlockMatrix &matrix)
    {
      std::vector<float> inverses(9 * matrix.n_rows() + read_beyond, 0.F);
      for (std::size_t row = 0; row < matrix.n_rows(); ++row)
      {
        const float *block = matrix.block(row, row);
        if (block == nullptr)
          continue;
        dealii::Tensor<2, 3> A, inverse;
        double               product = 1.;
        for (unsigned int i = 0; i < 3; ++i)
        {
          product *= std::max<double>(block[4 * i], 0.);
          inverse[i][i] = block[4 * i] > 0. ? 1. / block[4 * i] : 0.;
          for (unsigned int j = 0; j < 3; ++j)
            A[i][j] = 0.5 * (block[3 * j + i] + block[3 * i + j]);
        }
        if (dealii::determinant(A) > 1e-5 * product)
          inverse = dealii::invert(A);
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            inverses[9 * row + 3 * j + i] = static_cast<float>(inverse[i][j]);
      }
      return inverses;
    }

    /// Overwrite a symmetric n x n matrix by its Cholesky factor, with the inverses of the diagonal
    /// there; rows that depend on those before are zero.
    void
    factorize_dense(std::vector<double> &L, const std::size_t n)
    {
      for (std::size_t j = 0; j < n; ++j)
      {
        const double before = L[j * n + j];
        double       pivot  = before;
        for (std::size_t k = 0; k < j; ++k)
          pivot -= L[j * n + k] * L[j * n + k];
        const double inverse = pivot > 1e-6 * before ? 1. / std::sqrt(pivot) : 0.;
        for (std::size_t i = j + 1; i < n; ++i)
        {
          for (std::size_t k = 0; k < j; ++k)
            L[i * n + j] -= L[i * n + k] * L[j * n + k];
          L[i * n + j] *= inverse;
        }
        L[j * n + j] = inverse;
      }
    }

    /// Overwrite x by the inverse times x.
    void
    solve_dense(const std::vector<double> &L, std::vector<double> &x)
    {
      const std::size_t n = x.size();
      for (std::size_t i = 0; i < n; ++i)
      {
        for (std::size_t k = 0; k < i; ++k)
          x[i] -= L[i * n + k] * x[k];
        x[i] *= L[i * n + i];
      }
      for (std::size_t i = n; i-- > 0;)
      {
        for (std::size_t k = i + 1; k < n; ++k)
          x[i] -= L[k * n + i] * x[k];
        x[i] *= L[i * n + i];
      }
    }

    /// Numbers of all processes, one after the other; `firsts` as first_numbers().
    template <typename Number>
    std::vector<Number>
    gather_from_all(const std::vector<Number> &own,
                    const std::vector<int>    &firsts,
                    const int                  n_each,
                    const Exchange            &exchange)
    {
      if (exchange.n_processes() == 1)
        return own;
      std::vector<Number> all(static_cast<std::size_t>(n_each) * firsts.back());
      std::vector<int>    counts, places;
      for (std::size_t process = 0; process + 1 < firsts.size(); ++process)
      {
        counts.push_back(n_each * (firsts[process + 1] - firsts[process]));
        places.push_back(n_each * firsts[process]);
      }
      const MPI_Datatype type = std::is_same_v<Number, float> ? MPI_FLOAT : MPI_DOUBLE;
      MPI_Allgatherv(own.data(), static_cast<int>(own.size()), type, all.data(), counts.data(),
                     places.data(), type,
                     exchange.communicator());
      return all;
    }
  } // namespace

  MultigridInverse::MultigridInverse(const ML_Struct        &ml,
                                     const std::vector<int> &row_of,
                                     const Exchange         &exchange)
      : exchange(exchange), row_of(row_of)
  {
    const int down = ml.ML_finest_level < ml.ML_coarsest_level ? 1 : -1;
    for (int number = ml.ML_finest_level; number != ml.ML_coarsest_level + down; number += down)
    {
      const bool is_coarsest = number == ml.ML_coarsest_level;
      Level      level(copy_in_blocks(&ml.Amat[number], exchange),
                  is_coarsest ? BlockMatrix(0, 0, nullptr)
                                   : copy_in_blocks(&ml.Pmat[number + down], exchange));
      level.inverse_diagonal = invert_diagonal(level.matrix);
      for (BlockVector *vector :
           { &level.solution, &level.right_side, &level.correction, &level.residual })
        *vector = level.matrix.zeros();
      level.coarser = level.prolongation.zeros();
      levels.push_back(std::move(level));
    }
    invert_coarsest();
    const auto precondition = [](Level &level)
    { multiply_by_blocks(level.inverse_diagonal, level.right_side, 1.F, level.solution); };
    for (std::size_t number = 0; number + 1 < levels.size(); ++number)
      levels[number].greatest
          = find_eigenvalues(levels[number], n_lanczos_steps, precondition).second;
    spectrum = find_eigenvalues(levels[0], n_lanczos_steps, [this](Level &) { cycle(0); });
    spectrum.second *= cycle_is_above;
    n_cycles = find_n_cycles(spectrum.second / spectrum.first);
    step     = levels[0].matrix.zeros();
    count_operations();
  }

  void
  MultigridInverse::count_operations()
  {
    // nanoseconds on the machine of doc/speed.md; only their ratio matters
    std::vector<double> counts{ static_cast<double>(row_of.size()),
                                static_cast<double>(levels[0].matrix.n_blocks()), 0. };
    for (const Level &level : levels)
      counts[2] += 2. * smoother_degree * static_cast<double>(level.matrix.n_blocks())
                   + 2. * static_cast<double>(level.prolongation.n_blocks());
    exchange.sum(counts);
    const double iteration  = 60. * counts[0] + 2.6 * n_cycles * (counts[1] + counts[2]);
    relative_cost           = 2000. * counts[1] / iteration;
    relative_cost_of_column = 1100. * counts[1] / iteration; // by conjugate gradients to 1e-8
  }

  double
  MultigridInverse::dot(const BlockVector &a,
                        const BlockVector &b,
                        const std::size_t  n_blocks) const
  {
    double sum = 0.;
    for (std::size_t i = 0; i < n_blocks; ++i)
      for (unsigned int c = 0; c < 3; ++c)
        sum += static_cast<double>(a[4 * i + c]) * b[4 * i + c];
    return exchange.sum(sum);
  }

  template <typename Precondition>
  std::pair<double, double>
  MultigridInverse::find_eigenvalues(Level              &level,
                                     const unsigned int  n_steps,
                                     const Precondition &precondition) const
  {
    // conjugate gradients, of which the factors are those of Lanczos' method
    const std::size_t   n = level.matrix.n_rows();
    BlockVector         r = level.matrix.zeros(), p = r, image = r;
    std::vector<double> diagonal, beside;
    double              old_product = 0., old_length = 0.;
    for (std::size_t i = 0; i < 4 * n; ++i)
      r[i] = std::sin(1.F + 1.7F * static_cast<float>(i % 1000)); // any vector
    for (unsigned int k = 0; k < n_steps; ++k)
    {
      level.right_side = r;
      precondition(level);
      const double product = dot(r, level.solution, n);
      const double beta    = k == 0 ? 0. : product / old_product;
      for (std::size_t i = 0; i < 4 * n; ++i)
        p[i] = level.solution[i] + static_cast<float>(beta) * p[i];
      level.matrix.multiply(p, image);
      const double curvature = dot(p, image, n);
      if (!(product > 0. && curvature > 0.))
        break;
      const double length = product / curvature;
      for (std::size_t i = 0; i < 4 * n; ++i)
        r[i] -= static_cast<float>(length) * image[i];
      if (k > 0)
        beside.push_back(std::sqrt(beta) / old_length);
      diagonal.push_back(1. / length + (k == 0 ? 0. : beta / old_length));
      old_product = product;
      old_length  = length;
    }
    if (diagonal.empty()) // no rows
      return { 0.5, 1. };
    dealii::TridiagonalMatrix<double> tridiagonal(diagonal.size(), true);
    for (std::size_t i = 0; i < diagonal.size(); ++i)
    {
      tridiagonal(i, i) = diagonal[i];
      if (i + 1 < diagonal.size())
        tridiagonal(i, i + 1) = beside[i];
    }
    tridiagonal.compute_eigenvalues();
    return { tridiagonal.eigenvalue(0), tridiagonal.eigenvalue(diagonal.size() - 1) };
  }

  void
  MultigridInverse::invert_coarsest()
  {
    const BlockMatrix             &A      = levels.back().matrix;
    const std::vector<std::size_t> blocks = first_numbers(A.n_rows(), exchange);
    for (const std::size_t first : blocks)
      coarsest_firsts.push_back(static_cast<int>(3 * first));
    const std::size_t   n = coarsest_firsts.back(), n_own = 3 * A.n_rows();
    const std::size_t   first = coarsest_firsts[exchange.process()];
    std::vector<double> own(n_own * n, 0.);
    // columns of others have no numbers that would tell where they are: multiply by unit vectors
    BlockVector &x = levels.back().solution, &image = levels.back().residual;
    for (std::size_t column = 0; column < n; ++column)
    {
      std::fill(x.begin(), x.end(), 0.F);
      if (column >= first && column < first + n_own)
        x[4 * ((column - first) / 3) + (column - first) % 3] = 1.F;
      A.multiply(x, image);
      for (std::size_t i = 0; i < n_own; ++i)
        own[i * n + column] = image[4 * (i / 3) + i % 3];
    }
    std::vector<double> L = gather_from_all(own, coarsest_firsts, static_cast<int>(n), exchange);
    factorize_dense(L, n);
    coarsest.resize(n_own * n);
    std::vector<double> unit(n);
    for (std::size_t i = 0; i < n_own; ++i) // columns are rows
    {
      std::fill(unit.begin(), unit.end(), 0.);
      unit[first + i] = 1.;
      solve_dense(L, unit);
      std::copy(unit.begin(), unit.end(), &coarsest[i * n]);
    }
  }

  void
  MultigridInverse::solve_coarsest()
  {
    Level             &level = levels.back();
    const std::size_t  n_own = 3 * level.matrix.n_rows();
    std::vector<float> own(n_own);
    for (std::size_t i = 0; i < n_own; ++i)
      own[i] = level.right_side[4 * (i / 3) + i % 3];
    const std::vector<float> all = gather_from_all(own, coarsest_firsts, 1, exchange);
    for (std::size_t i = 0; i < n_own; ++i)
    {
      float sum = 0.F;
      for (std::size_t k = 0; k < all.size(); ++k)
        sum += coarsest[i * all.size() + k] * all[k];
      level.solution[4 * (i / 3) + i % 3] = sum;
    }
  }

  void
  MultigridInverse::smooth(Level &level, const bool from_zero) const
  {
    const double     greatest = greatest_is_above * level.greatest;
    ChebyshevFactors factors(greatest / smoother_range, greatest);
    for (unsigned int k = 0; k < smoother_degree; ++k)
    {
      const auto keep = static_cast<float>(factors.keep), take = static_cast<float>(factors.take);
      if (k == 0 && from_zero)
      {
        multiply_by_blocks(level.inverse_diagonal, level.right_side, take, level.correction);
        std::copy(level.correction.begin(), level.correction.end(), level.solution.begin());
      }
      else
        level.matrix.correct(level.inverse_diagonal, level.right_side, keep, take, level.solution,
                             level.correction);
      factors.advance();
    }
  }

  void
  MultigridInverse::cycle(const std::size_t number)
  {
    if (number + 1 == levels.size())
    {
      solve_coarsest();
      return;
    }
    Level &level = levels[number], &coarser = levels[number + 1];
    smooth(level, true);
    level.matrix.find_residual(level.right_side, level.solution, level.residual);
    level.prolongation.multiply_transposed(level.residual, level.coarser);
    const std::size_t n = 4 * coarser.matrix.n_rows();
    std::copy(level.coarser.begin(), level.coarser.begin() + n, coarser.right_side.begin());
    cycle(number + 1);
    std::copy(coarser.solution.begin(), coarser.solution.begin() + n, level.coarser.begin());
    level.prolongation.multiply_and_add(level.coarser, level.solution);
    smooth(level, false);
  }

  void
  MultigridInverse::solve(BlockVector &result)
  {
    Level            &finest     = levels[0];
    const BlockVector right_side = finest.right_side;
    ChebyshevFactors  factors(spectrum.first, spectrum.second);
    std::fill(step.begin(), step.end(), 0.F);
    result = step;
    for (unsigned int k = 0; k < n_cycles; ++k)
    {
      if (k > 0)
        finest.matrix.find_residual(right_side, result, finest.right_side);
      cycle(0);
      const auto keep = static_cast<float>(factors.keep), take = static_cast<float>(factors.take);
      for (std::size_t i = 0; i < 4 * finest.matrix.n_rows(); ++i)
      {
        step[i] = keep * step[i] + take * finest.solution[i];
        result[i] += step[i];
      }
      factors.advance();
    }
  }

  void
  MultigridInverse::apply(std::vector<double> &vector)
  {
    // of forces that shrink by ten orders of magnitude single precision would lose the last
    const double scale = exchange.max(max_entry(vector));
    if (scale == 0.)
      return;
    const auto   place      = [](const int row) { return 4 * (row / 3) + row % 3; };
    BlockVector &right_side = levels[0].right_side;
    std::fill(right_side.begin(), right_side.end(), 0.F);
    for (std::size_t i = 0; i < vector.size(); ++i)
      right_side[place(row_of[i])] = static_cast<float>(vector[i] / scale);
    BlockVector result;
    solve(result);
    for (std::size_t i = 0; i < vector.size(); ++i)
      vector[i] = scale * result[place(row_of[i])];
  }

  std::size_t
  MultigridInverse::memory_consumption() const
  {
    std::size_t n_floats = coarsest.capacity() + step.capacity();
    std::size_t bytes    = sizeof(int) * row_of.capacity();
    for (const Level &level : levels)
    {
      bytes += level.matrix.memory_consumption() + level.prolongation.memory_consumption();
      for (const auto *vector : { &level.inverse_diagonal, &level.solution, &level.right_side,
                                  &level.correction, &level.residual, &level.coarser })
        n_floats += vector->capacity();
    }
    return bytes + sizeof(float) * n_floats;
  }
} // namespace Exemplar
