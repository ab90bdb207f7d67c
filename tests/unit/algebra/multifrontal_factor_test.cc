// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/cholmod_analysis.h>
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/algebra/multifrontal_factor.h>
#include <exemplar/base/errors.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace Exemplar::Testing
{
  namespace
  {
    struct SparseMatrix
    {
      SymmetricPattern    pattern;
      std::vector<double> values;
    };

    /// Six on the diagonal and `shift`, -1 between neighbours in a grid of n x n x n points.
    SparseMatrix
    laplacian(const int n, const double shift)
    {
      SparseMatrix matrix;
      const auto   add = [&](const int row, const double value)
      {
        matrix.pattern.row.push_back(row);
        matrix.values.push_back(value);
      };
      for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
          for (int i = 0; i < n; ++i)
          {
            const int row = (k * n + j) * n + i;
            matrix.pattern.column_start.push_back(static_cast<int>(matrix.pattern.row.size()));
            add(row, 6. + shift);
            if (i + 1 < n)
              add(row + 1, -1.);
            if (j + 1 < n)
              add(row + n, -1.);
            if (k + 1 < n)
              add(row + n * n, -1.);
          }
      matrix.pattern.column_start.push_back(static_cast<int>(matrix.pattern.row.size()));
      matrix.values.resize(matrix.pattern.n_values());
      return matrix;
    }

    std::vector<double>
    random_columns(const std::size_t n)
    {
      std::mt19937                           generator(7);
      std::uniform_real_distribution<double> uniform(-1., 1.);
      std::vector<double>                    columns(n);
      for (double &entry : columns)
        entry = uniform(generator);
      return columns;
    }

    std::unique_ptr<SpdOperator>
    with(std::unique_ptr<SpdOperator> matrix, const SparseMatrix &values)
    {
      matrix->reinit(values.pattern);
      matrix->values() = values.values;
      return matrix;
    }

    std::vector<double>
    solution(std::unique_ptr<SpdOperator> matrix,
             const SparseMatrix          &values,
             std::vector<double>          columns)
    {
      const auto made = with(std::move(matrix), values);
      made->factorize({});
      made->solve(columns);
      return columns;
    }

    double
    difference(const std::vector<double> &a, const std::vector<double> &b)
    {
      double maximum = 0.;
      for (std::size_t i = 0; i < a.size(); ++i)
        maximum = std::max(maximum, std::abs(a[i] - b[i]));
      return maximum / max_entry(b);
    }

    std::shared_ptr<const FactorStructure>
    structure_of(const SymmetricPattern &pattern)
    {
      CholmodCommon   common;
      cholmod_factor *factor = analyze(pattern, common);
      const auto      result
          = std::make_shared<const FactorStructure>(factor_structure(pattern, *factor, common));
      cholmod_free_factor(&factor, &common);
      return result;
    }

    // Of 20 x 20 x 20 points the upper separators are great panels, for BLAS, and there is a top with
    // subtrees below; of 2 x 2 x 2 there is one panel.

    TEST(MultifrontalFactorTest, SolvesAsCholmodDoes)
    {
      for (const int n : { 1, 2, 5, 20 })
        for (const std::size_t n_columns : { 1, 2, 7 })
        {
          const SparseMatrix        matrix  = laplacian(n, 0.01);
          const std::vector<double> columns = random_columns(n_columns * n * n * n);
          EXPECT_LT(difference(solution(make_cholesky_operator(), matrix, columns),
                               solution(make_cholmod_operator(), matrix, columns)),
                    1e-12)
              << n << " " << n_columns;
        }
    }

    TEST(MultifrontalFactorTest, IsTheSameToTheByteForAnyNumberOfThreads)
    {
      const SparseMatrix matrix    = laplacian(20, 0.01);
      const auto         structure = structure_of(matrix.pattern);
      ASSERT_GT(structure->subtrees.size(), 3u);
      ASSERT_GT(structure->top.size(), 1u);
      ASSERT_GE(structure->n_columns(structure->n_supernodes() - 1), 256);
      const auto factorized = [&](const unsigned int n_threads)
      {
        MultifrontalFactor<double> factor(structure, n_threads);
        EXPECT_TRUE(factor.factorize(matrix.values));
        std::vector<double> x = random_columns(structure->n());
        factor.solve(x);
        x.insert(x.end(), factor.get_values(), factor.get_values() + structure->n_values());
        return x;
      };
      const std::vector<double> alone = factorized(1);
      for (const unsigned int n_threads : { 2, 5 })
        EXPECT_TRUE(factorized(n_threads) == alone) << n_threads;
    }

    TEST(MultifrontalFactorTest, ARoughOneHasFewDigitsAndItsSolutionAlmostAll)
    {
      const SparseMatrix        matrix = laplacian(12, 1.);
      const std::vector<double> b      = random_columns(2 * matrix.pattern.n());
      const std::vector<double> exact  = solution(make_cholmod_operator(), matrix, b);
      const auto                rough  = with(make_cholesky_operator(), matrix);
      rough->factorize_roughly({});

      std::vector<double> of_inverse(b.begin(), b.begin() + matrix.pattern.n()), refined = b;
      rough->keep()->apply(of_inverse);
      rough->solve(refined);
      const double error
          = difference(of_inverse, { exact.begin(), exact.begin() + matrix.pattern.n() });
      EXPECT_LT(error, 1e-5);
      EXPECT_GT(error, 1e-9);
      EXPECT_LT(difference(refined, exact), 1e-12);
    }

    TEST(MultifrontalFactorTest, EntriesOfTheInverseAreThoseOfItsColumns)
    {
      for (const int n : { 3, 14 }) // without subtrees, and with some
      {
        const SparseMatrix matrix = laplacian(n, 1.);
        const auto         rough  = with(make_cholesky_operator(2), matrix);
        rough->factorize_roughly({});
        const std::unique_ptr<KeptInverse>    inverse = rough->keep();
        const std::unique_ptr<InverseEntries> entries = inverse->entries();
        const int                             last    = n * n * n - 1;
        const std::vector<int>                unknowns
            = { 0, 1, last / 2, last / 2 + n, last / 3, last - 1, last };
        for (std::size_t i = 0; i < unknowns.size(); ++i)
          EXPECT_EQ(entries->add(unknowns[i]), i);
        for (std::size_t j = 0; j < unknowns.size(); ++j)
        {
          std::vector<double> column(matrix.pattern.n());
          column[unknowns[j]] = 1.;
          inverse->apply(column);
          for (std::size_t i = 0; i < unknowns.size(); ++i)
            EXPECT_NEAR(entries->entry(i, j), column[unknowns[i]], 1e-6 * column[unknowns[j]]);
        }
      }
    }

    TEST(MultifrontalFactorTest, SmallForcesKeepTheirDigitsInSinglePrecision)
    {
      const SparseMatrix matrix = laplacian(4, 1.);
      const auto         rough  = with(make_cholesky_operator(), matrix);
      rough->factorize_roughly({});
      std::vector<double> large = random_columns(matrix.pattern.n()), small = large;
      for (double &entry : small)
        entry *= std::pow(2., -200.);
      rough->keep()->apply(large);
      rough->keep()->apply(small);
      for (std::size_t i = 0; i < large.size(); ++i)
        EXPECT_EQ(small[i], std::pow(2., -200.) * large[i]);
    }

    TEST(MultifrontalFactorTest, SinglePrecisionHasRoomForMatricesOfAnySize)
    {
      const SparseMatrix matrix = laplacian(4, 1.);
      SparseMatrix       great  = matrix;
      for (double &entry : great.values)
        entry *= std::pow(2., 300.);
      const std::vector<double> b = random_columns(2 * matrix.pattern.n());
      const auto solve_roughly    = [&](const SparseMatrix &with_values, std::vector<double> x)
      {
        const auto rough = with(make_cholesky_operator(), with_values);
        rough->factorize_roughly({});
        rough->solve(x);
        std::vector<double> once(b.begin(), b.begin() + matrix.pattern.n());
        rough->keep()->apply(once);
        x.insert(x.end(), once.begin(), once.end());
        return x;
      };
      const std::vector<double> x = solve_roughly(matrix, b), of_great = solve_roughly(great, b);
      for (std::size_t i = 0; i < x.size(); ++i)
        EXPECT_EQ(of_great[i], std::pow(2., -300.) * x[i]);
      const auto exact = with(make_cholesky_operator(), great); // also from double precision
      exact->factorize({});
      std::vector<double> once(b.begin(), b.begin() + matrix.pattern.n());
      exact->keep()->apply(once);
      EXPECT_LT(difference(once, { of_great.end() - matrix.pattern.n(), of_great.end() }), 1e-5);
    }

    TEST(MultifrontalFactorTest, RefusesAnIndefiniteMatrix)
    {
      for (const int n : { 2, 20 })
      {
        const auto matrix = with(make_cholesky_operator(2), laplacian(n, -6.5));
        EXPECT_THROW(matrix->factorize({}), SolverFailure);
        EXPECT_THROW(matrix->factorize_roughly({}), SolverFailure);
        std::vector<double> column(n * n * n, 1.);
        EXPECT_THROW(matrix->solve(column), SolverFailure); // there is no factor
        EXPECT_THROW(matrix->keep(), SolverFailure);
        matrix->values() = laplacian(n, 0.).values; // and takes the next
        EXPECT_NO_THROW(matrix->factorize({}));
      }
    }

    TEST(MultifrontalFactorTest, WhatIsDefiniteInDoublePrecisionAloneIsFactorisedInThat)
    {
      // in single precision 1 + 1e-9 is 1, and the matrix singular
      SparseMatrix matrix;
      matrix.pattern.column_start = { 0, 2, 3 };
      matrix.pattern.row          = { 0, 1, 1 };
      matrix.values               = { 1., 1., 1. + 1e-9 };
      matrix.values.resize(matrix.pattern.n_values());
      const auto rough = with(make_cholesky_operator(), matrix);
      rough->factorize_roughly({});
      std::vector<double> x = { 0., 1e-9 };
      rough->solve(x);
      EXPECT_NEAR(x[0], -1., 1e-6);
      EXPECT_NEAR(x[1], 1., 1e-6);
    }

    TEST(MultifrontalFactorTest, CountsOperationsAndPivotsAsCholmodDoes)
    {
      const SparseMatrix matrix = laplacian(8, 0.1);
      const auto         own    = with(make_cholesky_operator(), matrix),
                 its            = with(make_cholmod_operator(), matrix);
      own->factorize({});
      its->factorize({});
      EXPECT_EQ(own->traits().n_operations, its->traits().n_operations);
      EXPECT_NEAR(own->traits().pivot_ratio, its->traits().pivot_ratio, 1e-10);
    }

    TEST(FactorStructureTest, TheTailOfASubtreeIsWhatItSeesOfTheTop)
    {
      const auto structure = structure_of(laplacian(16, 0.).pattern);
      ASSERT_GT(structure->tail.size(), 0u);
      std::vector<bool> is_of_top(structure->n(), false);
      for (const int s : structure->top)
        std::fill(is_of_top.begin() + structure->first_column[s],
                  is_of_top.begin() + structure->first_column[s + 1], true);
      for (const int row : structure->tail)
        EXPECT_TRUE(is_of_top[row]);
      for (const auto &subtree : structure->subtrees)
        for (std::size_t i = structure->first_row[subtree.begin];
             i < structure->first_row[subtree.end]; ++i)
        {
          const int row = structure->rows[i], of_tail = row - structure->n();
          EXPECT_TRUE(of_tail >= 0
                          ? of_tail >= subtree.begin_of_tail && of_tail < subtree.end_of_tail
                          : row >= structure->first_column[subtree.begin]
                                && row < structure->first_column[subtree.end]);
        }
    }
  } // namespace
} // namespace Exemplar::Testing
