// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_matrix3_h
#define exemplar_matrix3_h

// Vectors and matrices of three dimensions for the cell kernels. They are
// generic over the number type and include no deal.II header, because the
// kernels are to be compiled for several instruction sets.

namespace Exemplar
{
  template <typename Number>
  struct Vector3
  {
    Number value[3];

    Number &
    operator[](const int i)
    {
      return value[i];
    }

    const Number &
    operator[](const int i) const
    {
      return value[i];
    }
  };

  template <typename Number>
  struct Matrix3
  {
    Number value[3][3];

    Number *
    operator[](const int i)
    {
      return value[i];
    }

    const Number *
    operator[](const int i) const
    {
      return value[i];
    }
  };

  template <typename Number>
  Number
  dot(const Vector3<Number> &a, const Vector3<Number> &b)
  {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }

  template <typename Number>
  Vector3<Number>
  operator*(const Matrix3<Number> &A, const Vector3<Number> &b)
  {
    Vector3<Number> c;
    for (int i = 0; i < 3; ++i)
      c[i] = A[i][0] * b[0] + A[i][1] * b[1] + A[i][2] * b[2];
    return c;
  }

  template <typename Number>
  Matrix3<Number>
  operator*(const Matrix3<Number> &A, const Matrix3<Number> &B)
  {
    Matrix3<Number> C;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        C[i][j] = A[i][0] * B[0][j] + A[i][1] * B[1][j] + A[i][2] * B[2][j];
    return C;
  }

  /// A^T B.
  template <typename Number>
  Matrix3<Number>
  transpose_times(const Matrix3<Number> &A, const Matrix3<Number> &B)
  {
    Matrix3<Number> C;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        C[i][j] = A[0][i] * B[0][j] + A[1][i] * B[1][j] + A[2][i] * B[2][j];
    return C;
  }

  template <typename Number>
  Matrix3<Number>
  symmetric_part(const Matrix3<Number> &A)
  {
    Matrix3<Number> S;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        S[i][j] = Number(0.5) * (A[i][j] + A[j][i]);
    return S;
  }

  template <typename Number>
  Matrix3<Number>
  identity_matrix()
  {
    Matrix3<Number> I;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        I[i][j] = Number(i == j ? 1. : 0.);
    return I;
  }

  template <typename Number>
  Number
  trace(const Matrix3<Number> &A)
  {
    return A[0][0] + A[1][1] + A[2][2];
  }

  /// A : B.
  template <typename Number>
  Number
  contract(const Matrix3<Number> &A, const Matrix3<Number> &B)
  {
    Number sum = A[0][0] * B[0][0];
    for (int i = 0; i < 3; ++i)
      for (int j = (i == 0 ? 1 : 0); j < 3; ++j)
        sum += A[i][j] * B[i][j];
    return sum;
  }

  template <typename Number>
  Number
  determinant(const Matrix3<Number> &A)
  {
    return A[0][0] * (A[1][1] * A[2][2] - A[1][2] * A[2][1])
           - A[0][1] * (A[1][0] * A[2][2] - A[1][2] * A[2][0])
           + A[0][2] * (A[1][0] * A[2][1] - A[1][1] * A[2][0]);
  }

  /// Matrix of cofactors: A^T cof(A) = det(A) I.
  template <typename Number>
  Matrix3<Number>
  cofactors(const Matrix3<Number> &A)
  {
    Matrix3<Number> C;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
      {
        const int p = (i + 1) % 3, q = (i + 2) % 3, r = (j + 1) % 3, s = (j + 2) % 3;
        C[i][j] = A[p][r] * A[q][s] - A[p][s] * A[q][r];
      }
    return C;
  }
} // namespace Exemplar

#endif
