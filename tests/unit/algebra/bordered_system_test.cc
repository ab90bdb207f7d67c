// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/bordered_system.h>
#include <exemplar/base/errors.h>

#include <gtest/gtest.h>

#include <random>

namespace Exemplar::Testing
{
  namespace
  {
    constexpr unsigned int n = 30, k = 3;

    /// Every pair of neighbours i, i+1, i+5 is coupled.
    SymmetricPattern
    banded_pattern()
    {
      SymmetricPattern pattern;
      pattern.column_start.push_back(0);
      for (unsigned int column = 0; column < n; ++column)
      {
        for (const unsigned int offset : { 0u, 1u, 5u })
          if (column + offset < n)
            pattern.row.push_back(static_cast<int>(column + offset));
        pattern.column_start.push_back(static_cast<int>(pattern.row.size()));
      }
      return pattern;
    }

    void
    fill(std::vector<double> &values, const SymmetricPattern &pattern, const double diagonal)
    {
      std::mt19937                           generator(1);
      std::uniform_real_distribution<double> uniform(-1., 1.);
      for (unsigned int column = 0; column < n; ++column)
        for (int entry = pattern.column_start[column]; entry < pattern.column_start[column + 1];
             ++entry)
          values[entry]
              = pattern.row[entry] == static_cast<int>(column) ? diagonal : uniform(generator);
    }

    const WeightForm &
    weight_form()
    {
      static const WeightForm form = []
      {
        WeightForm result;
        result.H.reinit(k, k);
        result.N.reinit(1, k);
        for (unsigned int i = 0; i < k; ++i)
        {
          result.H(i, i) = 10.;
          result.N(0, i) = 1.;
          result.coupled.push_back(i);
        }
        return result;
      }();
      return form;
    }

    std::vector<double>
    random_columns()
    {
      std::mt19937                           generator(2);
      std::uniform_real_distribution<double> uniform(-1., 1.);
      std::vector<double>                    columns(n * k);
      for (double &entry : columns)
        entry = uniform(generator);
      return columns;
    }

    const WeightForm no_weights;

    std::unique_ptr<BorderedSystem>
    block_system(const SymmetricPattern &pattern, const WeightForm &form)
    {
      auto matrix = make_cholesky_operator();
      matrix->reinit(pattern);
      return make_block_system(std::move(matrix), form, Exchange::serial());
    }

    BorderedVector
    right_side(const bool with_weights)
    {
      BorderedVector vector;
      for (unsigned int i = 0; i < n; ++i)
        vector.positions.push_back(std::sin(i + 1.));
      if (with_weights)
      {
        vector.weights     = { 1., -2., 3. };
        vector.multipliers = { 0.5 };
      }
      return vector;
    }

    TEST(BorderedSystem, BlockEliminationAgreesWithUmfpack)
    {
      const SymmetricPattern pattern = banded_pattern();
      const auto             solve   = [&](BorderedSystem &system)
      {
        fill(system.matrix_values(), pattern, 8.);
        system.columns() = random_columns();
        system.factorize({});
        BorderedVector vector = right_side(true);
        system.solve(vector, {});
        return vector;
      };
      const BorderedVector a = solve(*block_system(pattern, weight_form()));
      const BorderedVector b = solve(*make_umfpack_system(pattern, weight_form()));
      for (unsigned int i = 0; i < n; ++i)
        EXPECT_NEAR(a.positions[i], b.positions[i], 1e-12);
      for (unsigned int i = 0; i < k; ++i)
        EXPECT_NEAR(a.weights[i], b.weights[i], 1e-12);
      EXPECT_NEAR(a.multipliers[0], b.multipliers[0], 1e-12);
      EXPECT_NEAR(a.weights[0] + a.weights[1] + a.weights[2], 0.5, 1e-13);
    }

    TEST(BorderedSystem, SolvesWhatItIsGiven)
    {
      // residual of the first and second block rows, written out
      const SymmetricPattern pattern = banded_pattern();
      const auto             system  = block_system(pattern, weight_form());
      fill(system->matrix_values(), pattern, 8.);
      system->columns() = random_columns();
      system->factorize({});
      const BorderedVector b = right_side(true);
      BorderedVector       x = b;
      system->solve(x, {});

      std::vector<double> residual = b.positions;
      for (unsigned int column = 0; column < n; ++column)
        for (int entry = pattern.column_start[column]; entry < pattern.column_start[column + 1];
             ++entry)
        {
          const int    row   = pattern.row[entry];
          const double value = system->matrix_values()[entry];
          residual[row] -= value * x.positions[column];
          if (row != static_cast<int>(column))
            residual[column] -= value * x.positions[row];
        }
      for (unsigned int j = 0; j < k; ++j)
      {
        double second = b.weights[j] - weight_form().H(j, j) * x.weights[j] - x.multipliers[0];
        for (unsigned int i = 0; i < n; ++i)
        {
          residual[i] += system->columns()[j * n + i] * x.weights[j];
          second += system->columns()[j * n + i] * x.positions[i];
        }
        EXPECT_NEAR(second, 0., 1e-12);
      }
      for (const double entry : residual)
        EXPECT_NEAR(entry, 0., 1e-12);
    }

    TEST(BorderedSystem, WithoutWeightsIsAPlainSolve)
    {
      const SymmetricPattern pattern = banded_pattern();
      const auto             solve   = [&](BorderedSystem &system)
      {
        fill(system.matrix_values(), pattern, 8.);
        system.factorize({});
        BorderedVector vector = right_side(false);
        system.solve(vector, {});
        return vector.positions;
      };
      const auto a = solve(*block_system(pattern, no_weights));
      const auto b = solve(*make_umfpack_system(pattern, no_weights));
      for (unsigned int i = 0; i < n; ++i)
        EXPECT_NEAR(a[i], b[i], 1e-13);
    }

    TEST(BorderedSystem, ReportsAnIndefiniteMatrix)
    {
      const SymmetricPattern pattern = banded_pattern();
      const auto             system  = block_system(pattern, no_weights);
      fill(system->matrix_values(), pattern, 0.1);
      EXPECT_THROW(system->factorize({}), SolverFailure);
      fill(system->matrix_values(), pattern, 8.); // and can be used again
      EXPECT_NO_THROW(system->factorize({}));
    }
  } // namespace
} // namespace Exemplar::Testing
