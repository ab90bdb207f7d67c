// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_blas_h
#define exemplar_blas_h

// A function of BLAS for both precisions. Matrices are stored by columns, `stride` apart. No
// deal.II header here: see matrix3.h.

extern "C"
{
  void
  dgemm_(const char *,
         const char *,
         const int *,
         const int *,
         const int *,
         const double *,
         const double *,
         const int *,
         const double *,
         const int *,
         const double *,
         double *,
         const int *);
  void
  sgemm_(const char *,
         const char *,
         const int *,
         const int *,
         const int *,
         const float *,
         const float *,
         const int *,
         const float *,
         const int *,
         const float *,
         float *,
         const int *);
}

namespace Exemplar::Blas
{
  /// A column-major matrix: address of its first entry, and leading dimension.
  template <typename Number>
  struct Matrix
  {
    Number *values;
    int     stride;
  };

  /// C = beta C - op(A) op(B), with m x n entries of C and k columns of op(A); op is the transpose
  /// where `transposed` says "T".
  template <typename Number>
  void
  subtract_product(const char          *transposed_A,
                   const char          *transposed_B,
                   const int            m,
                   const int            n,
                   const int            k,
                   Matrix<const Number> A,
                   Matrix<const Number> B,
                   const Number         beta,
                   Matrix<Number>       C)
  {
    const Number minus_one = -1.;
    if constexpr (sizeof(Number) == sizeof(double))
      dgemm_(transposed_A, transposed_B, &m, &n, &k, &minus_one, A.values, &A.stride, B.values,
             &B.stride, &beta, C.values, &C.stride);
    else
      sgemm_(transposed_A, transposed_B, &m, &n, &k, &minus_one, A.values, &A.stride, B.values,
             &B.stride, &beta, C.values, &C.stride);
  }
} // namespace Exemplar::Blas

#endif
