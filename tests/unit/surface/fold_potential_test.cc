// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/mesh.h>
#include <exemplar/surface/posing/fold_potential.h>

#include "fold_bodies.h"
#include "matrices.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    /// The bar with every second node on a spring, and its nodes somewhere else.
    class FoldPotentialTest : public testing::Test
    {
    protected:
      FoldPotentialTest() : bar(small_bar()), potential(bar.get_nodes(), bar.get_cells())
      {
        std::mt19937 generator(4);
        for (unsigned int i = 0; i < bar.n_nodes(); ++i)
        {
          const Matrix3<double>  A = random_matrix(generator);
          const dealii::Point<3> a(A[0][0], A[0][1], A[0][2]);
          potential.attachment.target[i] += 0.3 * a;
          potential.attachment.stiffness[i] = i % 2 == 0 ? 0. : 1. + i;
          x.push_back(bar.get_nodes()[i] + 0.2 * dealii::Point<3>(A[1][0], A[1][1], A[1][2]));
          direction.insert(direction.end(), A[2], A[2] + 3);
        }
      }

      FoldPotential::Points
      moved(const double factor) const
      {
        FoldPotential::Points result = x;
        for (std::size_t k = 0; k < direction.size(); ++k)
          result[k / 3][k % 3] += factor * direction[k];
        return result;
      }

      const Mesh            bar;
      FoldPotential         potential;
      FoldPotential::Points x;
      std::vector<double>   direction;
      const double          eps = 0.7;
    };

    std::vector<double>
    times(const SymmetricPattern    &pattern,
          const std::vector<double> &values,
          const std::vector<double> &v)
    {
      std::vector<double> result(pattern.n(), 0.);
      for (unsigned int j = 0; j < pattern.n(); ++j)
        for (int p = pattern.column_start[j]; p < pattern.column_start[j + 1]; ++p)
        {
          result[pattern.row[p]] += values[p] * v[j];
          if (pattern.row[p] != static_cast<int>(j))
            result[j] += values[p] * v[pattern.row[p]];
        }
      return result;
    }

    TEST_F(FoldPotentialTest, GradientIsTheDerivative)
    {
      const double h = 1e-6;
      const double change
          = (potential.value(moved(h), eps) - potential.value(moved(-h), eps)) / (2. * h);
      const std::vector<double> gradient = potential.gradient(x, eps);
      double                    expected = 0.;
      for (std::size_t k = 0; k < direction.size(); ++k)
        expected += gradient[k] * direction[k];
      EXPECT_NEAR(change, expected, 1e-7 * std::abs(expected));
    }

    TEST_F(FoldPotentialTest, MatrixIsTheSecondDerivativeOfASwollenBody)
    {
      // there no cell has a negative part, and turning one costs energy
      x                              = mapped(bar.get_nodes(), [](const dealii::Point<3> &y)
                                              { return dealii::Point<3>(1.2 * y[0], 1.2 * y[1], 1.2 * y[2]); });
      const SymmetricPattern pattern = potential.block_pattern();
      std::vector<double>    values(pattern.n_values());
      potential.assemble(x, 0., values);
      const std::vector<double> expected = times(pattern, values, direction);
      const double              h        = 1e-6;
      const auto                after    = potential.gradient(moved(h), 0.),
                 before                  = potential.gradient(moved(-h), 0.);
      double maximum                     = 0.;
      for (const double entry : expected)
        maximum = std::max(maximum, std::abs(entry));
      for (std::size_t k = 0; k < direction.size(); ++k)
        EXPECT_NEAR((after[k] - before[k]) / (2. * h), expected[k], 1e-6 * maximum);
    }

    TEST_F(FoldPotentialTest, MatrixIsPositiveWhereCellsAreInverted)
    {
      const auto determinants = potential.determinants(x);
      EXPECT_LT(*std::min_element(determinants.begin(), determinants.end()), 0.);
      const SymmetricPattern pattern = potential.block_pattern();
      const auto             system  = make_cholesky_operator();
      system->reinit(pattern);
      potential.assemble(x, eps, system->values());
      EXPECT_NO_THROW(system->factorize({}));
    }

    TEST_F(FoldPotentialTest, NearestRotationsOfARigidMotionAreTheMotion)
    {
      const Matrix3<double> R = rotation_about({ { 1., -2., .5 } }, 0.4);
      for (unsigned int i = 0; i < bar.n_nodes(); ++i)
        for (int r = 0; r < 3; ++r)
        {
          x[i][r] = 0.;
          for (int c = 0; c < 3; ++c)
            x[i][r] += R[r][c] * bar.get_nodes()[i][c];
        }
      potential.attachment.target = x;
      const auto system           = make_cholesky_operator();
      system->reinit(potential.node_pattern());
      potential.assemble_rotations(system->values());
      system->factorize({});
      std::vector<double> columns = potential.rotated_rest(&x);
      system->solve(columns);
      for (unsigned int i = 0; i < bar.n_nodes(); ++i)
        for (int d = 0; d < 3; ++d)
          EXPECT_NEAR(columns[d * bar.n_nodes() + i], x[i][d], 1e-12);
    }

    TEST(FoldPotentialThreadsTest, ResultsDoNotDependOnTheirNumber)
    {
      const Mesh                       bar = small_bar(5);
      const Points                     x   = bent(bar.get_nodes(), 2.);
      std::vector<std::vector<double>> results[2];
      for (const unsigned int n_threads : { 1U, 3U })
      {
        const FoldPotential potential(bar.get_nodes(), bar.get_cells(), n_threads);
        EXPECT_EQ(potential.get_n_threads(), n_threads);
        std::vector<double> matrix(potential.block_pattern().row.size());
        potential.assemble(x, 0.1, matrix);
        results[n_threads / 2] = { { potential.value(x, 0.1) },
                                   potential.gradient(x, 0.1),
                                   potential.determinants(x),
                                   potential.rotated_rest(&x),
                                   matrix };
      }
      EXPECT_EQ(results[0], results[1]);
    }
  } // namespace
} // namespace Exemplar::Testing
