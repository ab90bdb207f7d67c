// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/initial_stress.h>
#include <exemplar/kernels/polar_decomposition.h>

#include <gtest/gtest.h>

#include <cmath>

namespace Exemplar::Testing
{
  namespace
  {
    const Matrix3<double> some_stress{
      { { 2., 0.3, -0.7 }, { 0.3, -1., 0.4 }, { -0.7, 0.4, 0.5 } }
    };

    InitialStress
    stressed_cell(const Matrix3<double> &F)
    {
      return InitialStress(some_stress, closest_rotation(F), F);
    }

    Matrix3<double>
    stressed_force(const Matrix3<double> &F)
    {
      return closest_rotation(F) * stressed_cell(F).force();
    }

    /// Sheared and turned, and with two stretches that nearly cancel, where the guard acts.
    const Matrix3<double> deformations[]
        = { { { { 0.9, -0.5, 0.2 }, { 0.6, 1.2, -0.1 }, { 0.1, 0.3, 1.1 } } },
            { { { 1.4, 0.2, 0. }, { -0.1, 0.5, 0.1 }, { 0., 0.2, -0.37 } } } };

    TEST(InitialStress, ForceAndResponseAreDerivatives)
    {
      const double h = 1e-5;
      for (const Matrix3<double> &F : deformations)
      {
        const Matrix3<double> R = closest_rotation(F), P = stressed_force(F);
        for (int j = 0; j < 3; ++j)
          for (int l = 0; l < 3; ++l)
          {
            Matrix3<double> more = F, less = F, M{};
            more[j][l] += h;
            less[j][l] -= h;
            for (int i = 0; i < 3; ++i)
              M[i][l] = R[j][i];
            EXPECT_NEAR((stressed_cell(more).energy() - stressed_cell(less).energy()) / (2. * h),
                        P[j][l], 1e-7);
            const Matrix3<double> dP = R * stressed_cell(F).response(M);
            const Matrix3<double> by_force
                = combine(0.5 / h, stressed_force(more), -0.5 / h, stressed_force(less));
            for (int i = 0; i < 3; ++i)
              for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(by_force[i][k], dP[i][k], 1e-6);
          }
      }
      const auto &F   = deformations[1];
      const auto  S   = symmetric_part(transpose_times(closest_rotation(F), F));
      auto        sum = combine(-1., S, 0., S);
      for (int i = 0; i < 3; ++i)
        sum[i][i] += trace(S);
      EXPECT_LT(determinant(sum), 0.8) << "the guard acts in the second";
    }

    TEST(InitialStress, IsTheStressAtRestAndTurnsWithTheCell)
    {
      const auto I = identity_matrix<double>();
      EXPECT_EQ(stressed_cell(I).energy(), 0.);
      const Matrix3<double> P = stressed_force(I);
      const double          c = std::cos(2.), s = std::sin(2.);
      const Matrix3<double> Q{ { { c, -s, 0. }, { s, c, 0. }, { 0., 0., 1. } } };
      const Matrix3<double> turned = stressed_force(Q), of_turn = Q * some_stress;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
        {
          EXPECT_NEAR(P[i][j], some_stress[i][j], 1e-14);
          EXPECT_NEAR(turned[i][j], of_turn[i][j], 1e-14);
        }
      EXPECT_NEAR(stressed_cell(Q).energy(), 0., 1e-14);
    }
  } // namespace
} // namespace Exemplar::Testing
