// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/spd_operator.h>

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    constexpr unsigned int n_sheared = 6;

    /// T^T A T on a band for a shear of the last two unknowns, and the full A.
    struct ShearedCase
    {
      ShearedCase()
      {
        for (unsigned int j = 0; j < n_sheared; ++j)
        {
          pattern.column_start.push_back(pattern.row.size());
          for (unsigned int i = j; i < std::min(n_sheared, j + 2); ++i)
            pattern.row.push_back(i);
        }
        pattern.column_start.push_back(pattern.row.size());
        shear.sheared = { 4, 5 };
        shear.ends    = { 2, 3 };
        shear.others  = { 0, 2, 3 };
        shear.factors = { 0.5, -2., 0.7 };
      }

      double
      value(const unsigned int i, const unsigned int j) const
      {
        return i == j ? 3. + i : (i + 1 == j || j + 1 == i) ? -1. : 0.;
      }

      void
      set(std::vector<double> &values) const
      {
        values.assign(pattern.n_values(), 0.);
        for (unsigned int j = 0; j < n_sheared; ++j)
          for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k)
            values[k] = value(pattern.row[k], j);
      }

      /// A u, with A = N^T B N and N u = u with u_4 += .5 u_0 - 2 u_2 and u_5 += .7 u_3.
      std::vector<double>
      product(const std::vector<double> &u) const
      {
        double N[n_sheared][n_sheared] = {};
        for (unsigned int i = 0; i < n_sheared; ++i)
          N[i][i] = 1.;
        N[4][0] = 0.5;
        N[4][2] = -2.;
        N[5][3] = 0.7;
        std::vector<double> v(n_sheared, 0.), f(n_sheared, 0.), result(n_sheared, 0.);
        for (unsigned int i = 0; i < n_sheared; ++i)
          for (unsigned int j = 0; j < n_sheared; ++j)
            v[i] += N[i][j] * u[j];
        for (unsigned int i = 0; i < n_sheared; ++i)
          for (unsigned int j = 0; j < n_sheared; ++j)
            f[i] += value(i, j) * v[j];
        for (unsigned int i = 0; i < n_sheared; ++i)
          for (unsigned int j = 0; j < n_sheared; ++j)
            result[i] += N[j][i] * f[j];
        return result;
      }

      SymmetricPattern    pattern;
      UnknownShear        shear;
      std::vector<double> u = { 0.3, -1., 2., 0.5, 0.7, -0.2 };
    };

    TEST(ShearedOperator, SolvesForTheUnknownsThemselves)
    {
      const ShearedCase of;
      const auto        matrix = make_sheared_operator(make_cholesky_operator(), n_sheared);
      matrix->reinit(of.pattern);
      of.set(matrix->values());
      *matrix->shear() = of.shear;
      matrix->factorize({});
      std::vector<double> columns = of.product(of.u);
      for (unsigned int i = 0; i < n_sheared; ++i)
        columns.push_back(2. * columns[i]);
      matrix->solve(columns, 0.);
      for (unsigned int i = 0; i < n_sheared; ++i)
      {
        EXPECT_NEAR(columns[i], of.u[i], 1e-14);
        EXPECT_NEAR(columns[n_sheared + i], 2. * of.u[i], 1e-14);
      }
      // what is kept has the shear of then
      const auto kept            = matrix->keep();
      const auto twin            = matrix->twin();
      matrix->shear()->factors   = { 0., 0., 0. };
      std::vector<double> column = of.product(of.u);
      kept->apply(column);
      for (unsigned int i = 0; i < n_sheared; ++i)
        EXPECT_NEAR(column[i], of.u[i], 1e-6);
      EXPECT_TRUE(twin->shear()->sheared.empty());
    }
  } // namespace
} // namespace Exemplar::Testing
