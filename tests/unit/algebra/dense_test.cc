// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/dense.h>

#include <gtest/gtest.h>

#include <cmath>

namespace Exemplar::Testing
{
  namespace
  {
    using Matrix = dealii::FullMatrix<double>;

    /// B B^T, of which row `dependent` of B is the sum of the rows before.
    Matrix
    gram_matrix(const unsigned int n, const unsigned int dependent)
    {
      Matrix B(n, n), gram(n, n);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
        {
          B(i, j) = i == dependent ? 0. : std::sin(1. + 3. * i + i * j);
          for (unsigned int before = 0; i == dependent && before < i; ++before)
            B(i, j) += B(before, j);
        }
      B.mTmult(gram, B);
      return gram;
    }

    TEST(Dense, CholeskysFactorSeesTheLowerTriangleAlone)
    {
      const unsigned int n = 5;
      const Matrix       A = gram_matrix(n, n); // no row depends on others
      Matrix             L = A;
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = i + 1; j < n; ++j)
          L(i, j) = NAN;
      ASSERT_TRUE(factorize_by_cholesky(L, [](unsigned int, const double pivot, const double)
                                        { return pivot; }));
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j <= i; ++j)
        {
          double product = 0.;
          for (unsigned int k = 0; k <= j; ++k)
            product += L(i, k) * L(j, k);
          EXPECT_NEAR(product, A(i, j), 1e-13);
        }
    }

    TEST(Dense, RowsThatDependOnOthersGetZero)
    {
      const unsigned int n = 5, dependent = 3;
      const Matrix       A = gram_matrix(n, dependent);
      // the right side of a solution that is zero there
      const std::vector<double> expected{ 1., -2., 3., 0., 5. };
      std::vector<double>       b(n, 0.);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          b[i] += A(i, j) * expected[j];
      Matrix L = A;
      ASSERT_TRUE(factorize_by_cholesky(L, [](unsigned int, const double pivot, const double entry)
                                        { return pivot > 1e-10 * entry ? pivot : 0.; }));
      EXPECT_EQ(L(dependent, dependent), 0.);
      EXPECT_EQ(L(dependent + 1, dependent), 0.);
      solve_with_factor(L, b);
      for (unsigned int i = 0; i < n; ++i)
        EXPECT_NEAR(b[i], expected[i], 1e-9);

      // who wants all rows is told
      L = A;
      EXPECT_FALSE(solve_by_cholesky(L, b));
      EXPECT_EQ(min_pivot(A, 1e-10).row, dependent);
    }
  } // namespace
} // namespace Exemplar::Testing
