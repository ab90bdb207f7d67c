// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/patch_cell.h>

#include "matrices.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    Matrix3<double>
    stretch(const double a, const double b, const double c)
    {
      return { { { a, 0., 0. }, { 0., b, 0. }, { 0., 0., c } } };
    }

    /// r of the stretch S.
    double
    supplement(const Matrix3<double> &S)
    {
      return ThinTrace<double>::of_strain(combine(1., S, -1., identity_matrix<double>()))
          .supplement();
    }

    TEST(ThinTrace, TheSupplementIsThatOfEquation25)
    {
      // r = y_0/3 (1 - y/y_0)^3 with y_0 = 0.4 and y = (s_1+s_2)(s_2+s_3)(s_3+s_1) / |S|^2
      const auto expected = [](const double a, const double b, const double c)
      {
        const double y = (a + b) * (b + c) * (c + a) / (a * a + b * b + c * c);
        return y < 0.4 ? 0.4 / 3. * std::pow(1. - y / 0.4, 3) : 0.;
      };
      EXPECT_EQ(expected(1., 1., 1.), 0.);
      EXPECT_GT(expected(2., 0.02, 0.05), 0.05);
      EXPECT_GT(expected(2., 0.3, -0.2), 0.05);
      for (const auto &[a, b, c] : { std::array<double, 3>{ { 1., 1., 1. } },
                                     { { 2., 0.1, 0.05 } },
                                     { { 2., 0.02, 0.05 } },
                                     { { 2., 0.3, -0.2 } },
                                     { { 3., 0.2, 0.1 } },
                                     { { 0.5, 0.5, -0.45 } } })
        EXPECT_NEAR(supplement(stretch(a, b, c)), expected(a, b, c), 1e-14);
    }

    TEST(ThinTrace, TheSupplementDoesNotKnowHowTheBodyIsTurned)
    {
      const Matrix3<double> Q = rotation_about({ { 1., -2., 0.5 } }, 1.1);
      Matrix3<double>       turned;
      const Matrix3<double> QS = Q * stretch(2., 0.02, 0.05);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
        {
          turned[i][j] = 0.;
          for (int k = 0; k < 3; ++k)
            turned[i][j] += QS[i][k] * Q[j][k];
        }
      EXPECT_NEAR(supplement(turned), supplement(stretch(2., 0.02, 0.05)), 1e-13);
    }
  } // namespace
} // namespace Exemplar::Testing
