// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_dual_h
#define exemplar_dual_h

#include <exemplar/kernels/neo_hookean_cell.h>

#include <array>
#include <utility>

// Dual numbers, which carry derivatives, for the laws of a cell, which are templates of the number
// type. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// A number with its derivatives by n parameters; Real is double, or a register with a number a
  /// lane. The derivatives of constants are stored as zeros: loops without branches are faster than
  /// tests for constants.
  template <std::size_t n, typename Real = double>
  struct Dual
  {
    static constexpr std::size_t n_derivatives = n;

    using Value = Real;

    Real                value = Real(0.);
    std::array<Real, n> by    = zeros(std::make_index_sequence<n>());

    Dual() = default;

    /// A constant.
    explicit Dual(const double value) : value(value) {}

    /// A function of the first parameter, with derivative `change`.
    Dual(const Real &value, const Real &change) : value(value)
    {
      if constexpr (n > 0)
        by[0] = change;
    }

    [[gnu::always_inline]] Dual &
    operator+=(const Dual &x)
    {
      value += x.value;
      for (std::size_t k = 0; k < n; ++k)
        by[k] += x.by[k];
      return *this;
    }

    [[gnu::always_inline]] Dual &
    operator-=(const Dual &x)
    {
      value -= x.value;
      for (std::size_t k = 0; k < n; ++k)
        by[k] -= x.by[k];
      return *this;
    }

    [[gnu::always_inline]] Dual &
    operator*=(const Dual &x)
    {
      for (std::size_t k = 0; k < n; ++k)
        by[k] = by[k] * x.value + value * x.by[k];
      value *= x.value;
      return *this;
    }

    Dual &
    operator*=(const double factor)
    {
      value *= Real(factor);
      for (Real &derivative : by)
        derivative *= Real(factor);
      return *this;
    }

    Dual &
    operator/=(const Dual &x)
    {
      return *this *= inverse(x);
    }

  private:
    template <std::size_t... k>
    static std::array<Real, n>
    zeros(std::index_sequence<k...> /*derivatives*/)
    {
      return { { ((void) k, Real(0.))... } };
    }
  };

  /// Chain rule for g(x), given the value and the first derivative of g at x.
  template <std::size_t n, typename Real>
  Dual<n, Real>
  chained(const Dual<n, Real> &x, const Real &g, const Real &first)
  {
    Dual<n, Real> result;
    result.value = g;
    for (std::size_t k = 0; k < n; ++k)
      result.by[k] = first * x.by[k];
    return result;
  }

  template <std::size_t n, typename Real>
  Dual<n, Real>
  inverse(const Dual<n, Real> &x)
  {
    const Real i = Real(1.) / x.value;
    return chained(x, i, -i * i);
  }

  template <std::size_t n, typename Real>
  Dual<n, Real>
  sqrt(const Dual<n, Real> &x)
  {
    const Real root = sqrt(x.value);
    return chained(x, root, Real(0.5) / root);
  }

  template <std::size_t n, typename Real>
  [[gnu::always_inline]] inline Dual<n, Real>
  operator-(const Dual<n, Real> &x)
  {
    return Dual<n, Real>() -= x;
  }

  template <std::size_t n, typename Real>
  [[gnu::always_inline]] inline Dual<n, Real>
  operator+(Dual<n, Real> x, const Dual<n, Real> &y)
  {
    return x += y;
  }

  template <std::size_t n, typename Real>
  [[gnu::always_inline]] inline Dual<n, Real>
  operator-(Dual<n, Real> x, const Dual<n, Real> &y)
  {
    return x -= y;
  }

  template <std::size_t n, typename Real>
  [[gnu::always_inline]] inline Dual<n, Real>
  operator*(Dual<n, Real> x, const Dual<n, Real> &y)
  {
    return x *= y;
  }

  template <std::size_t n, typename Real>
  Dual<n, Real>
  operator/(Dual<n, Real> x, const Dual<n, Real> &y)
  {
    return x /= y;
  }

  // Comparisons depend on values alone.

  template <std::size_t n, typename Real>
  auto
  operator==(const Dual<n, Real> &x, const Dual<n, Real> &y)
  {
    return x.value == y.value;
  }

  template <std::size_t n, typename Real>
  auto
  operator<(const Dual<n, Real> &x, const Dual<n, Real> &y)
  {
    return x.value < y.value;
  }

  template <std::size_t n, typename Real>
  auto
  operator>(const Dual<n, Real> &x, const Dual<n, Real> &y)
  {
    return x.value > y.value;
  }

  template <std::size_t n, typename Real>
  auto
  operator<=(const Dual<n, Real> &x, const Dual<n, Real> &y)
  {
    return x.value <= y.value;
  }

  template <std::size_t n, typename Real>
  auto
  operator>=(const Dual<n, Real> &x, const Dual<n, Real> &y)
  {
    return x.value >= y.value;
  }

  /// For a register lane by lane.
  template <typename Mask, std::size_t n, typename Real>
  Dual<n, Real>
  select(const Mask &condition, const Dual<n, Real> &x, const Dual<n, Real> &y)
  {
    Dual<n, Real> result;
    result.value = select(condition, x.value, y.value);
    for (std::size_t k = 0; k < n; ++k)
      result.by[k] = select(condition, x.by[k], y.by[k]);
    return result;
  }

  template <std::size_t n, typename Real>
  Dual<n, Real>
  max(const Dual<n, Real> &x, const Dual<n, Real> &y)
  {
    return select(x.value < y.value, y, x);
  }

  template <std::size_t n, typename Real>
  Dual<n, Real>
  abs(const Dual<n, Real> &x)
  {
    return select(x.value < Real(0.), -x, x);
  }

  template <std::size_t n, typename Real>
  Dual<n, Real>
  hypot(const Dual<n, Real> &x, const Dual<n, Real> &y)
  {
    return sqrt(x * x + y * y);
  }

  /// x - log(1 + x).
  template <std::size_t n, typename Real>
  Dual<n, Real>
  beyond_logarithm(const Dual<n, Real> &x)
  {
    return chained(x, beyond_logarithm(x.value), x.value / (Real(1.) + x.value));
  }

  /// The matrix of part(number) of each entry.
  template <typename Real, typename Number, typename Part>
  Matrix3<Real>
  parts_of(const Matrix3<Number> &A, const Part &part)
  {
    Matrix3<Real> result;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        result[i][j] = part(A[i][j]);
    return result;
  }

  /// A matrix that changes with the first parameter.
  template <typename Number, typename Real>
  Matrix3<Number>
  changing(const Matrix3<Real> &value, const Matrix3<Real> &change)
  {
    Matrix3<Number> result;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        result[i][j] = Number(value[i][j], change[i][j]);
    return result;
  }

  /// factor A of a factor without derivatives.
  template <std::size_t n, typename Real>
  Matrix3<Dual<n, Real>>
  times(const double factor, Matrix3<Dual<n, Real>> A)
  {
    for (auto &row : A.value)
      for (Dual<n, Real> &entry : row)
        entry *= factor;
    return A;
  }

  /// The inverse without bounds, because eigenvectors have no derivatives where eigenvalues coincide.
  template <std::size_t n, typename Real>
  Matrix3<Dual<n, Real>>
  bounded_inverse(const Matrix3<Dual<n, Real>> &B, const Dual<n, Real> & /*minimum*/)
  {
    return inverse_of_symmetric(B);
  }
} // namespace Exemplar

#endif
