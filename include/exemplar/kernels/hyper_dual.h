// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_hyper_dual_h
#define exemplar_hyper_dual_h

#include <exemplar/kernels/neo_hookean_cell.h>

#include <array>
#include <cmath>

// Dual and hyper-dual numbers, which carry derivatives, for the laws of a cell, which are templates
// of the number type. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// A number with its derivatives by n parameters. The derivatives of constants are stored as
  /// zeros: loops without branches are faster than tests for constants.
  template <std::size_t n>
  struct Dual
  {
    double                value = 0.;
    std::array<double, n> by    = {};

    Dual() = default;

    /// A constant.
    explicit Dual(const double value) : value(value) {}

    /// A function of the first parameter, with derivative `change`.
    Dual(const double value, const double change) : value(value)
    {
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
    operator/=(const Dual &x)
    {
      return *this *= inverse(x);
    }
  };

  /// A hyper-dual number (Fike and Alonso 2011): a function f(t, p) at t = 0, with df/dt, its
  /// derivatives by n parameters p, and those of df/dt by p. Arithmetic is exact up to rounding.
  template <std::size_t n>
  struct HyperDual
  {
    double                value     = 0.;
    double                change    = 0.; ///< df/dt
    std::array<double, n> by        = {};
    std::array<double, n> change_by = {};

    HyperDual() = default;

    /// A constant.
    explicit HyperDual(const double value) : value(value) {}

    /// A function of t, with derivative `change`.
    HyperDual(const double value, const double change) : value(value), change(change) {}

    HyperDual &
    operator+=(const HyperDual &x)
    {
      value += x.value;
      change += x.change;
      for (std::size_t k = 0; k < n; ++k)
        by[k] += x.by[k];
      for (std::size_t k = 0; k < n; ++k)
        change_by[k] += x.change_by[k];
      return *this;
    }

    HyperDual &
    operator-=(const HyperDual &x)
    {
      value -= x.value;
      change -= x.change;
      for (std::size_t k = 0; k < n; ++k)
        by[k] -= x.by[k];
      for (std::size_t k = 0; k < n; ++k)
        change_by[k] -= x.change_by[k];
      return *this;
    }

    HyperDual &
    operator*=(const HyperDual &x)
    {
      for (std::size_t k = 0; k < n; ++k)
        change_by[k]
            = change_by[k] * x.value + by[k] * x.change + change * x.by[k] + value * x.change_by[k];
      for (std::size_t k = 0; k < n; ++k)
        by[k] = by[k] * x.value + value * x.by[k];
      change = change * x.value + value * x.change;
      value *= x.value;
      return *this;
    }

    HyperDual &
    operator/=(const HyperDual &x)
    {
      return *this *= inverse(x);
    }
  };

  /// Chain rule for g(x), given the value and the first two derivatives of g at x.
  template <std::size_t n>
  HyperDual<n>
  chained(const HyperDual<n> &x, const double g, const double first, const double second)
  {
    HyperDual<n> result(g, first * x.change);
    for (std::size_t k = 0; k < n; ++k)
      result.by[k] = first * x.by[k];
    for (std::size_t k = 0; k < n; ++k)
      result.change_by[k] = first * x.change_by[k] + second * x.change * x.by[k];
    return result;
  }

  template <std::size_t n>
  Dual<n>
  chained(const Dual<n> &x, const double g, const double first, const double /*second*/)
  {
    Dual<n> result(g);
    for (std::size_t k = 0; k < n; ++k)
      result.by[k] = first * x.by[k];
    return result;
  }

  // The following functions are for both kinds of numbers.

  template <template <std::size_t> class Kind, std::size_t n>
  Kind<n>
  inverse(const Kind<n> &x)
  {
    const double i = 1. / x.value;
    return chained(x, i, -i * i, 2. * i * i * i);
  }

  template <template <std::size_t> class Kind, std::size_t n>
  Kind<n>
  sqrt(const Kind<n> &x)
  {
    const double root = std::sqrt(x.value);
    return chained(x, root, 0.5 / root, -0.25 / (root * x.value));
  }

  template <template <std::size_t> class Kind, std::size_t n>
  [[gnu::always_inline]] inline Kind<n>
  operator-(const Kind<n> &x)
  {
    return Kind<n>() -= x;
  }

  template <template <std::size_t> class Kind, std::size_t n>
  [[gnu::always_inline]] inline Kind<n>
  operator+(Kind<n> x, const Kind<n> &y)
  {
    return x += y;
  }

  template <template <std::size_t> class Kind, std::size_t n>
  [[gnu::always_inline]] inline Kind<n>
  operator-(Kind<n> x, const Kind<n> &y)
  {
    return x -= y;
  }

  template <template <std::size_t> class Kind, std::size_t n>
  [[gnu::always_inline]] inline Kind<n>
  operator*(Kind<n> x, const Kind<n> &y)
  {
    return x *= y;
  }

  template <template <std::size_t> class Kind, std::size_t n>
  Kind<n>
  operator/(Kind<n> x, const Kind<n> &y)
  {
    return x /= y;
  }

  // Comparisons depend on values alone.

  template <template <std::size_t> class Kind, std::size_t n>
  bool
  operator==(const Kind<n> &x, const Kind<n> &y)
  {
    return x.value == y.value;
  }

  template <template <std::size_t> class Kind, std::size_t n>
  bool
  operator<(const Kind<n> &x, const Kind<n> &y)
  {
    return x.value < y.value;
  }

  template <template <std::size_t> class Kind, std::size_t n>
  bool
  operator>(const Kind<n> &x, const Kind<n> &y)
  {
    return x.value > y.value;
  }

  template <template <std::size_t> class Kind, std::size_t n>
  bool
  operator<=(const Kind<n> &x, const Kind<n> &y)
  {
    return x.value <= y.value;
  }

  template <template <std::size_t> class Kind, std::size_t n>
  bool
  operator>=(const Kind<n> &x, const Kind<n> &y)
  {
    return x.value >= y.value;
  }

  template <template <std::size_t> class Kind, std::size_t n>
  Kind<n>
  max(const Kind<n> &x, const Kind<n> &y)
  {
    return x.value < y.value ? y : x;
  }

  template <template <std::size_t> class Kind, std::size_t n>
  Kind<n>
  abs(const Kind<n> &x)
  {
    return x.value < 0. ? -x : x;
  }

  template <template <std::size_t> class Kind, std::size_t n>
  Kind<n>
  select(const bool condition, const Kind<n> &x, const Kind<n> &y)
  {
    return condition ? x : y;
  }

  /// x - log(1 + x).
  template <template <std::size_t> class Kind, std::size_t n>
  Kind<n>
  beyond_logarithm(const Kind<n> &x)
  {
    const double i = 1. / (1. + x.value);
    return chained(x, x.value - std::log1p(x.value), x.value * i, i * i);
  }
} // namespace Exemplar

#endif
