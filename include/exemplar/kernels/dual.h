// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_dual_h
#define exemplar_dual_h

#include <exemplar/kernels/neo_hookean_cell.h>

#include <array>
#include <cmath>

// Dual numbers, which carry derivatives, for the laws of a cell, which are templates of the number
// type. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// A number with its derivatives by n parameters. The derivatives of constants are stored as
  /// zeros: loops without branches are faster than tests for constants.
  template <std::size_t n>
  struct Dual
  {
    static constexpr std::size_t n_derivatives = n;

    double                value = 0.;
    std::array<double, n> by    = {};

    Dual() = default;

    /// A constant.
    explicit Dual(const double value) : value(value) {}

    /// A function of the first parameter, with derivative `change`.
    Dual(const double value, const double change) : value(value)
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
      value *= factor;
      for (double &derivative : by)
        derivative *= factor;
      return *this;
    }

    Dual &
    operator/=(const Dual &x)
    {
      return *this *= inverse(x);
    }
  };

  /// Chain rule for g(x), given the value and the first derivative of g at x.
  template <std::size_t n>
  Dual<n>
  chained(const Dual<n> &x, const double g, const double first)
  {
    Dual<n> result(g);
    for (std::size_t k = 0; k < n; ++k)
      result.by[k] = first * x.by[k];
    return result;
  }

  template <std::size_t n>
  Dual<n>
  inverse(const Dual<n> &x)
  {
    const double i = 1. / x.value;
    return chained(x, i, -i * i);
  }

  template <std::size_t n>
  Dual<n>
  sqrt(const Dual<n> &x)
  {
    const double root = std::sqrt(x.value);
    return chained(x, root, 0.5 / root);
  }

  template <std::size_t n>
  [[gnu::always_inline]] inline Dual<n>
  operator-(const Dual<n> &x)
  {
    return Dual<n>() -= x;
  }

  template <std::size_t n>
  [[gnu::always_inline]] inline Dual<n>
  operator+(Dual<n> x, const Dual<n> &y)
  {
    return x += y;
  }

  template <std::size_t n>
  [[gnu::always_inline]] inline Dual<n>
  operator-(Dual<n> x, const Dual<n> &y)
  {
    return x -= y;
  }

  template <std::size_t n>
  [[gnu::always_inline]] inline Dual<n>
  operator*(Dual<n> x, const Dual<n> &y)
  {
    return x *= y;
  }

  template <std::size_t n>
  Dual<n>
  operator/(Dual<n> x, const Dual<n> &y)
  {
    return x /= y;
  }

  // Comparisons depend on values alone.

  template <std::size_t n>
  bool
  operator==(const Dual<n> &x, const Dual<n> &y)
  {
    return x.value == y.value;
  }

  template <std::size_t n>
  bool
  operator<(const Dual<n> &x, const Dual<n> &y)
  {
    return x.value < y.value;
  }

  template <std::size_t n>
  bool
  operator>(const Dual<n> &x, const Dual<n> &y)
  {
    return x.value > y.value;
  }

  template <std::size_t n>
  bool
  operator<=(const Dual<n> &x, const Dual<n> &y)
  {
    return x.value <= y.value;
  }

  template <std::size_t n>
  bool
  operator>=(const Dual<n> &x, const Dual<n> &y)
  {
    return x.value >= y.value;
  }

  template <std::size_t n>
  Dual<n>
  max(const Dual<n> &x, const Dual<n> &y)
  {
    return x.value < y.value ? y : x;
  }

  template <std::size_t n>
  Dual<n>
  abs(const Dual<n> &x)
  {
    return x.value < 0. ? -x : x;
  }

  template <std::size_t n>
  Dual<n>
  hypot(const Dual<n> &x, const Dual<n> &y)
  {
    return sqrt(x * x + y * y);
  }

  template <std::size_t n>
  Dual<n>
  select(const bool condition, const Dual<n> &x, const Dual<n> &y)
  {
    return condition ? x : y;
  }

  /// x - log(1 + x).
  template <std::size_t n>
  Dual<n>
  beyond_logarithm(const Dual<n> &x)
  {
    return chained(x, x.value - std::log1p(x.value), x.value / (1. + x.value));
  }

  /// factor A of a factor without derivatives.
  template <std::size_t n>
  Matrix3<Dual<n>>
  times(const double factor, Matrix3<Dual<n>> A)
  {
    for (auto &row : A.value)
      for (Dual<n> &entry : row)
        entry *= factor;
    return A;
  }

  /// The inverse without bounds, because eigenvectors have no derivatives where eigenvalues coincide.
  template <std::size_t n>
  Matrix3<Dual<n>>
  bounded_inverse(const Matrix3<Dual<n>> &B, const Dual<n> & /*minimum*/)
  {
    return inverse_of_symmetric(B);
  }
} // namespace Exemplar

#endif
