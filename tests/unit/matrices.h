// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_matrices_h
#define exemplar_tests_matrices_h

#include <exemplar/kernels/matrix3.h>

#include <algorithm>
#include <cmath>
#include <random>

// Matrices that the kernels' tests are made of.
namespace Exemplar::Testing
{
  inline Matrix3<double>
  random_matrix(std::mt19937 &generator)
  {
    std::normal_distribution<double> normal;
    Matrix3<double>                  A;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        A[i][j] = normal(generator);
    return A;
  }

  /// Rotation by `angle` about `axis` (Rodrigues).
  inline Matrix3<double>
  rotation_about(Vector3<double> axis, const double angle)
  {
    const double length = std::sqrt(dot(axis, axis));
    for (int i = 0; i < 3; ++i)
      axis[i] /= length;
    const Matrix3<double> W
        = { { { 0., -axis[2], axis[1] }, { axis[2], 0., -axis[0] }, { -axis[1], axis[0], 0. } } };
    const Matrix3<double> W2 = W * W;
    Matrix3<double>       R  = identity_matrix<double>();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        R[i][j] += std::sin(angle) * W[i][j] + (1. - std::cos(angle)) * W2[i][j];
    return R;
  }

  inline double
  max_difference(const Matrix3<double> &A, const Matrix3<double> &B)
  {
    double difference = 0.;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        difference = std::max(difference, std::abs(A[i][j] - B[i][j]));
    return difference;
  }
} // namespace Exemplar::Testing

#endif
