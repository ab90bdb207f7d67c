// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_matrices_h
#define exemplar_tests_matrices_h

#include <exemplar/kernels/matrix3.h>
#include <exemplar/verification/verification_scene.h>

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

  using Verification::rotation_about;

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
