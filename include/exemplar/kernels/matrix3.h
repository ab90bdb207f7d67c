// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_matrix3_h
#define exemplar_matrix3_h

// Vectors and matrices of three dimensions for the cell kernels, generic over the number type. They
// include no deal.II header, because the kernels are compiled for several instruction sets.

#include <exemplar/kernels/lanes.h>

namespace Exemplar
{
  /// Three numbers; a number may be a pack of lanes, one for each of several cells.
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

  /// A matrix of 3 x 3 numbers, by rows.
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
  [[gnu::always_inline]] inline Vector3<Number>
  operator*(const Matrix3<Number> &A, const Vector3<Number> &b)
  {
    Vector3<Number> c;
    for (int i = 0; i < 3; ++i)
      c[i] = A[i][0] * b[0] + A[i][1] * b[1] + A[i][2] * b[2];
    return c;
  }

  template <typename Number>
  [[gnu::always_inline]] inline Matrix3<Number>
  operator*(const Matrix3<Number> &A, const Matrix3<Number> &B)
  {
    Matrix3<Number> C;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        C[i][j] = A[i][0] * B[0][j] + A[i][1] * B[1][j] + A[i][2] * B[2][j];
    return C;
  }

  /// factor A.
  template <typename Number>
  [[gnu::always_inline]] inline Matrix3<Number>
  times(const Number &factor, Matrix3<Number> A)
  {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        A[i][j] *= factor;
    return A;
  }

  /// a A + b B.
  template <typename Number>
  [[gnu::always_inline]] inline Matrix3<Number>
  combine(const Number &a, const Matrix3<Number> &A, const Number &b, const Matrix3<Number> &B)
  {
    Matrix3<Number> C;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        C[i][j] = a * A[i][j] + b * B[i][j];
    return C;
  }

  /// A where `condition` holds, else B.
  template <typename Mask, typename Number>
  Matrix3<Number>
  select_matrix(const Mask &condition, const Matrix3<Number> &A, const Matrix3<Number> &B)
  {
    Matrix3<Number> C;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        C[i][j] = select(condition, A[i][j], B[i][j]);
    return C;
  }

  /// A^T B.
  template <typename Number>
  [[gnu::always_inline]] inline Matrix3<Number>
  transpose_times(const Matrix3<Number> &A, const Matrix3<Number> &B)
  {
    Matrix3<Number> C;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        C[i][j] = A[0][i] * B[0][j] + A[1][i] * B[1][j] + A[2][i] * B[2][j];
    return C;
  }

  template <typename Number>
  [[gnu::always_inline]] inline Matrix3<Number>
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
  [[gnu::always_inline]] inline Number
  trace(const Matrix3<Number> &A)
  {
    return A[0][0] + A[1][1] + A[2][2];
  }

  /// A - tr(A)/3 I.
  template <typename Number>
  Matrix3<Number>
  deviator(Matrix3<Number> A)
  {
    const Number third = trace(A) / Number(3.);
    for (int i = 0; i < 3; ++i)
      A[i][i] -= third;
    return A;
  }

  /// A : B.
  template <typename Number>
  [[gnu::always_inline]] inline Number
  contract(const Matrix3<Number> &A, const Matrix3<Number> &B)
  {
    Number sum = A[0][0] * B[0][0];
    for (int i = 0; i < 3; ++i)
      for (int j = (i == 0 ? 1 : 0); j < 3; ++j)
        sum += A[i][j] * B[i][j];
    return sum;
  }

  /// (A:A)^(1/2).
  template <typename Number>
  [[gnu::always_inline]] inline Number
  norm(const Matrix3<Number> &A)
  {
    return sqrt(contract(A, A));
  }

  template <typename Number>
  [[gnu::always_inline]] inline Number
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

  /// A^-1 of a symmetric matrix.
  template <typename Number>
  Matrix3<Number>
  inverse_of_symmetric(const Matrix3<Number> &A)
  {
    return times(Number(1.) / determinant(A), cofactors(A)); // symmetric, too
  }

  /// Tangent of the angle of the Jacobi rotation that diagonalises [a b; b d].
  template <typename Number>
  Number
  jacobi_tangent(const Number &a, const Number &b, const Number &d)
  {
    const auto   is_diagonal = b == Number(0.);
    const Number theta       = (d - a) / select(is_diagonal, Number(1.), Number(2.) * b);
    const Number sign        = select(theta >= Number(0.), Number(1.), Number(-1.));
    return select(is_diagonal, Number(0.), sign / (abs(theta) + sqrt(theta * theta + Number(1.))));
  }

  /// Eigenvalues of a symmetric matrix, in no order, and the eigenvectors as columns of an
  /// orthogonal matrix.
  template <typename Number>
  struct Eigensystem
  {
    Vector3<Number> values;
    Matrix3<Number> vectors;
  };

  /// Eigensystem by cyclic Jacobi rotations; robust where eigenvalues coincide.
  template <typename Number>
  Eigensystem<Number>
  symmetric_eigensystem(Matrix3<Number> A)
  {
    Matrix3<Number> V = identity_matrix<Number>();
    for (int sweep = 0; sweep < 8; ++sweep)
      for (int p = 0; p < 2; ++p)
        for (int q = p + 1; q < 3; ++q)
        {
          const Number t = jacobi_tangent(A[p][p], A[p][q], A[q][q]);
          const Number c = Number(1.) / sqrt(t * t + Number(1.));
          const Number s = t * c;
          for (int k = 0; k < 3; ++k)
          {
            const Number a = A[k][p];
            A[k][p]        = c * a - s * A[k][q];
            A[k][q]        = s * a + c * A[k][q];
          }
          for (int k = 0; k < 3; ++k)
          {
            const Number a = A[p][k];
            A[p][k]        = c * a - s * A[q][k];
            A[q][k]        = s * a + c * A[q][k];
            const Number v = V[k][p];
            V[k][p]        = c * v - s * V[k][q];
            V[k][q]        = s * v + c * V[k][q];
          }
        }
    return { { { A[0][0], A[1][1], A[2][2] } }, V };
  }

  /// The matrix function sum_e f(l_e) v_e v_e^T over the eigenvalues l_e and eigenvectors v_e of a
  /// symmetric matrix.
  template <typename Number, typename Function>
  Matrix3<Number>
  spectral_function(const Matrix3<Number> &A, const Function &f)
  {
    const Eigensystem<Number> eigen = symmetric_eigensystem(A);
    Matrix3<Number>           result{};
    for (int e = 0; e < 3; ++e)
    {
      const Number value = f(eigen.values[e]);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          result[i][j] += value * eigen.vectors[i][e] * eigen.vectors[j][e];
    }
    return result;
  }
} // namespace Exemplar

#endif
