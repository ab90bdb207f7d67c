// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/spd_operator.h>

#include <deal.II/lac/full_matrix.h>

#include <gtest/gtest.h>

#include <random>

namespace Exemplar::Testing
{
  namespace
  {
    constexpr unsigned int n_dofs = 30;

    /// A band matrix over free degrees of freedom, some of which are held, with two products; and its dense inverse.
    struct LowRankCase
    {
      explicit LowRankCase(const double stiffness)
          : free_dofs(n_dofs, { 3, 7, 8 }, Exchange::serial()), n(free_dofs.list().size()),
            dense(n, n)
      {
        for (unsigned int j = 0; j < n; ++j)
        {
          pattern.column_start.push_back(pattern.row.size());
          for (unsigned int i = j; i < std::min(n, j + 3); ++i)
            pattern.row.push_back(i);
        }
        pattern.column_start.push_back(pattern.row.size());
        matrix = make_low_rank_operator(make_cholesky_operator(), free_dofs);
        matrix->reinit(pattern);
        std::vector<double> &values = matrix->values();
        for (unsigned int j = 0; j < n; ++j)
          for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k)
          {
            values[k]                = pattern.row[k] == static_cast<int>(j) ? 4. + 0.1 * j : -1.;
            dense(j, pattern.row[k]) = dense(pattern.row[k], j) = values[k];
          }
        std::mt19937                     engine(1);
        std::uniform_real_distribution<> random(-1., 1.);
        for (const double factor : { stiffness, 0., 0.5 * stiffness })
        {
          std::vector<unsigned int> nodes;
          std::vector<double>       numbers, u(n, 0.);
          for (unsigned int node = 0; node < n_dofs / 3; ++node)
            nodes.insert(nodes.begin(), node); // in any order
          for (const unsigned int node : nodes)
            for (unsigned int c = 0; c < 3; ++c)
            {
              numbers.push_back(random(engine));
              if (const int row = free_dofs.free_index(3 * node + c); row != FreeDofs::held)
                u[row] = numbers.back();
            }
          matrix->outer_products()->add(factor, nodes, numbers);
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int j = 0; j < n; ++j)
              dense(i, j) += factor * u[i] * u[j];
        }
        dense.gauss_jordan();
      }

      /// The greatest difference of a column of the inverse, over its greatest entry.
      double
      difference(const std::vector<double> &column, const unsigned int j) const
      {
        double greatest = 0., error = 0.;
        for (unsigned int i = 0; i < n; ++i)
        {
          greatest = std::max(greatest, std::abs(dense(i, j)));
          error    = std::max(error, std::abs(dense(i, j) - column[i]));
        }
        return error / greatest;
      }

      std::vector<double>
      unit(const unsigned int j) const
      {
        std::vector<double> column(n, 0.);
        column[j] = 1.;
        return column;
      }

      FreeDofs                     free_dofs;
      unsigned int                 n;
      dealii::FullMatrix<double>   dense; ///< the inverse
      SymmetricPattern             pattern;
      std::unique_ptr<SpdOperator> matrix;
    };

    TEST(LowRankOperator, SolvesAsADenseMatrixDoes)
    {
      for (const double stiffness : { 1e-3, 1., 1e6 })
      {
        LowRankCase of(stiffness);
        for (const bool roughly : { false, true })
        {
          if (roughly)
            of.matrix->factorize_roughly({});
          else
            of.matrix->factorize({});
          std::vector<double> columns = of.unit(4);
          const auto          more    = of.unit(11);
          columns.insert(columns.end(), more.begin(), more.end());
          of.matrix->solve(columns);
          EXPECT_LT(of.difference({ columns.begin(), columns.begin() + of.n }, 4), 1e-9);
          EXPECT_LT(of.difference({ columns.begin() + of.n, columns.end() }, 11), 1e-9);
        }
      }
    }

    TEST(LowRankOperator, KeepsItsInverse)
    {
      for (const double stiffness : { 1e-3, 1., 1e6 })
      {
        LowRankCase of(stiffness);
        of.matrix->factorize_roughly({});
        const auto kept = of.matrix->keep();
        of.matrix->outer_products()->clear();
        of.matrix->factorize({});
        const auto entries = kept->entries();
        for (unsigned int j = 0; j < of.n; ++j)
          entries->add(j);
        for (unsigned int j = 0; j < of.n; ++j)
        {
          std::vector<double> column = of.unit(j);
          kept->apply(column);
          EXPECT_LT(of.difference(column, j), 1e-5);
          for (unsigned int i = 0; i < of.n; ++i)
            EXPECT_NEAR(entries->entry(i, j), column[i], 1e-6);
          EXPECT_GT(column[j], 0.);
        }
      }
    }

    TEST(LowRankOperator, HasATwinWithProductsOfItsOwn)
    {
      LowRankCase of(1.);
      const auto  twin = of.matrix->twin();
      twin->values()   = of.matrix->values();
      twin->factorize({});
      of.matrix->factorize({});
      std::vector<double> with = of.unit(0), without = of.unit(0);
      of.matrix->solve(with);
      twin->solve(without);
      EXPECT_LT(of.difference(with, 0), 1e-12);
      EXPECT_GT(of.difference(without, 0), 1e-2);
    }
  } // namespace
} // namespace Exemplar::Testing
