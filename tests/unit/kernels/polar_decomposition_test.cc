// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/polar_decomposition.h>

#include "matrices.h"

#include <deal.II/lac/lapack_full_matrix.h>

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    Matrix3<double>
    scaled(const Matrix3<double> &A, const double factor)
    {
      Matrix3<double> B = A;
      for (auto &row : B.value)
        for (double &entry : row)
          entry *= factor;
      return B;
    }

    /// max tr(R^T F) over proper rotations: s1 + s2 + sign(det F) s3, by LAPACK's SVD.
    double
    optimum(const Matrix3<double> &F)
    {
      dealii::LAPACKFullMatrix<double> A(3, 3);
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          A(i, j) = F[static_cast<int>(i)][j];
      A.compute_svd();
      // scaled first, because the determinant of a tiny matrix underflows
      const double sign = determinant(scaled(F, 1. / A.singular_value(0))) < 0. ? -1. : 1.;
      return A.singular_value(0) + A.singular_value(1) + sign * A.singular_value(2);
    }

    void
    expect_closest_rotation(const Matrix3<double> &F, const std::string &what)
    {
      const Matrix3<double> R = closest_rotation(F);
      EXPECT_LT(max_difference(transpose_times(R, R), identity_matrix<double>()), 1e-13) << what;
      EXPECT_NEAR(determinant(R), 1., 1e-13) << what;
      const double size = std::sqrt(contract(F, F));
      EXPECT_NEAR(trace(transpose_times(R, F)), optimum(F), 2e-13 * (size + 1e-300)) << what;
    }

    TEST(PolarDecomposition, FindsTheOptimumOnRandomMatrices)
    {
      std::mt19937 generator(1);
      for (int sample = 0; sample < 2000; ++sample)
        expect_closest_rotation(random_matrix(generator), "random");
    }

    TEST(PolarDecomposition, LeavesASymmetricStretch)
    {
      std::mt19937 generator(2);
      for (int sample = 0; sample < 500; ++sample)
      {
        const Matrix3<double> F = random_matrix(generator);
        const Matrix3<double> S = transpose_times(closest_rotation(F), F);
        EXPECT_LT(max_difference(S, symmetric_part(S)), 1e-11);
      }
    }

    TEST(PolarDecomposition, RecoversARotationOfAnyAngle)
    {
      const Vector3<double> axis = { { 1., -2., 0.5 } };
      for (const double degrees : { 0., 1e-6, 90., 179.9, 180., 181., 359. })
      {
        const Matrix3<double> R = rotation_about(axis, degrees * M_PI / 180.);
        const Matrix3<double> U = { { { 2., .3, 0. }, { .3, .7, .1 }, { 0., .1, 1.1 } } };
        EXPECT_LT(max_difference(closest_rotation(R * U), R), 1e-13) << degrees;
      }
    }

    TEST(PolarDecomposition, SurvivesDegenerateMatrices)
    {
      std::mt19937          generator(3);
      const Matrix3<double> Q         = rotation_about({ { 1., 2., 3. } }, 2.5);
      const auto with_singular_values = [&](const double a, const double b, const double c)
      {
        const Matrix3<double> D = { { { a, 0., 0. }, { 0., b, 0. }, { 0., 0., c } } };
        return Q * D * rotation_about({ { 0., 1., 1. } }, 0.7);
      };
      expect_closest_rotation(with_singular_values(1., 1., -1.), "mirrored");
      expect_closest_rotation(with_singular_values(2., 1., -1.), "mirrored, tie");
      expect_closest_rotation(with_singular_values(2., 1., -0.999999), "mirrored, near tie");
      expect_closest_rotation(with_singular_values(2., 1., 0.), "flat");
      expect_closest_rotation(with_singular_values(2., 1., -1e-9), "nearly flat");
      expect_closest_rotation(with_singular_values(2., 0., 0.), "line");
      expect_closest_rotation(with_singular_values(1., 1e-8, -1e-8), "nearly line");
      expect_closest_rotation(scaled(random_matrix(generator), 1e-160), "tiny");
      expect_closest_rotation(scaled(random_matrix(generator), 1e150), "huge");
      EXPECT_EQ(max_difference(closest_rotation(Matrix3<double>{}), identity_matrix<double>()), 0.);
    }
  } // namespace
} // namespace Exemplar::Testing
