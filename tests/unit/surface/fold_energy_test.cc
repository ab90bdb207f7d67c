// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/posing/fold_energy.h>

#include "matrices.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    Matrix3<double>
    diagonal(const double a, const double b, const double c)
    {
      return { { { a, 0., 0. }, { 0., b, 0. }, { 0., 0., c } } };
    }

    /// Random ones of either orientation, a collapsed one, rest and a turned and stretched one.
    std::vector<Matrix3<double>>
    gradients_of_all_kinds()
    {
      std::mt19937                 generator(1);
      std::vector<Matrix3<double>> result = { identity_matrix<double>(), diagonal(1.2, 0.7, 0.),
                                              diagonal(1.2, 0.7, -0.3), diagonal(2., 2., -2.) };
      result.push_back(rotation_about({ { 1., -2., .5 } }, 2.5) * diagonal(0.3, 1.7, 1.1));
      for (int k = 0; k < 10; ++k)
        result.push_back(random_matrix(generator));
      return result;
    }

    /// The second derivative as a product with M.
    Matrix3<double>
    product(const FoldModes &modes, const Matrix3<double> &M)
    {
      Matrix3<double> result{};
      for (int m = 0; m < 9; ++m)
        result = combine(1., result, modes.stiffness[m] * contract(modes.direction[m], M),
                         modes.direction[m]);
      return result;
    }

    double
    size(const Matrix3<double> &A)
    {
      return std::sqrt(contract(A, A));
    }

    TEST(FoldEnergy, IsZeroForRotationsAlone)
    {
      const Matrix3<double> R = rotation_about({ { 1., -2., .5 } }, 2.5);
      EXPECT_NEAR(fold_energy(R, 0.), 0., 1e-14);
      EXPECT_LT(size(fold_stress(R, 0.)), 1e-14);
      // |F|^2 / det^(2/3) + (det^2 + 1) / det - 5 by hand
      EXPECT_NEAR(fold_energy(diagonal(2., 2., 2.), 0.), 3. + 65. / 8. - 5., 1e-13);
      EXPECT_NEAR(fold_energy(R * diagonal(2., 1., 0.5), 0.), 5.25 + 2. - 5., 1e-13);
    }

    TEST(FoldEnergy, IsInfiniteForInvertedCellsOnlyWithoutRegularisation)
    {
      for (const double minimum : { 0., -0.2 })
      {
        EXPECT_EQ(fold_energy(diagonal(1., 1., minimum), 0.),
                  std::numeric_limits<double>::infinity());
        double before = 0.;
        for (const double eps : { 1., 1e-2, 1e-4 })
        {
          const double now = fold_energy(diagonal(1., 1., minimum), eps);
          EXPECT_TRUE(std::isfinite(now));
          EXPECT_GT(now, 10. * before);
          before = std::max(now, 0.1);
        }
      }
      const Matrix3<double> F = diagonal(1.3, 0.4, 0.9);
      EXPECT_NEAR(fold_energy(F, 1e-9), fold_energy(F, 0.), 1e-12);
    }

    TEST(FoldEnergy, StressIsItsDerivative)
    {
      std::mt19937 generator(2);
      for (const auto &F : gradients_of_all_kinds())
        for (const double eps : { 1., 0.2, 0.05 })
        {
          const Matrix3<double> M = random_matrix(generator);
          const double          h = 1e-5 * eps;
          const double          change
              = fold_energy(combine(1., F, h, M), eps) - fold_energy(combine(1., F, -h, M), eps);
          const double expected = contract(fold_stress(F, eps), M);
          const double scale    = size(fold_stress(F, eps)) * size(M) + 1.;
          EXPECT_NEAR(change / (2. * h), expected, 1e-6 * scale) << eps;
        }
    }

    TEST(FoldEnergy, ModesAreItsSecondDerivative)
    {
      std::mt19937 generator(3);
      for (const auto &F : gradients_of_all_kinds())
        for (const double eps : { 1., 0.2, 0.05 })
        {
          const FoldModes       modes = fold_modes(F, eps);
          const Matrix3<double> M = random_matrix(generator), expected = product(modes, M);
          const double          h       = 1e-5 * eps;
          const Matrix3<double> change  = combine(0.5 / h, fold_stress(combine(1., F, h, M), eps),
                                                  -0.5 / h, fold_stress(combine(1., F, -h, M), eps));
          double                maximum = 1.;
          for (const double stiffness : modes.stiffness)
            maximum = std::max(maximum, std::abs(stiffness));
          EXPECT_LT(max_difference(change, expected), 1e-6 * maximum * size(M)) << eps;
        }
    }

    TEST(FoldEnergy, ModesAreOrthonormal)
    {
      for (const auto &F : gradients_of_all_kinds())
      {
        const FoldModes modes = fold_modes(F, 0.1);
        for (int m = 0; m < 9; ++m)
          for (int n = 0; n < 9; ++n)
            EXPECT_NEAR(contract(modes.direction[m], modes.direction[n]), m == n ? 1. : 0., 1e-12);
      }
    }
  } // namespace
} // namespace Exemplar::Testing
