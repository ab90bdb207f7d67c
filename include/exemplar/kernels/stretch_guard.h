// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_stretch_guard_h
#define exemplar_stretch_guard_h

#include <exemplar/kernels/elasticity.h>

// The guard of strongly stretched cells. The energy (5) of plain elasticity is
// mu (|F|^2 + 3) - 2 mu tr S + lambda/2 (tr S - 3)^2. All of it is smooth in F but tr S, which has
// a kink like |s_2 + s_3| where the least singular values of F cancel (s_3 < 0 in a mirrored cell)
// and S is not unique. The slope of the energy by s_2 + s_3 is
//
//   c = lambda (tr S - 3) - 2 mu
//
// there, positive once s_1 > 1 + 1/nu: then the kink is a minimum at which no gradient vanishes,
// and no method converges. The guard adds, Eq. (24),
//
//   Gamma = 4 q(c(|F|)) r(y),   r(y) = y_0/3 (1 - y/y_0)^3 for y < y_0, else 0,   y = p / |F|^2,
//
// with p = (s_1+s_2)(s_2+s_3)(s_3+s_1) and a smooth q >= max(c, 0). At the kink y is about
// s_2 + s_3 and r' = -1, so that the slope of the whole is about c - 4 q < 0: cells are pushed off
// the kink to where the energy has a smooth minimum. Gamma is 0 unless |F| > 1 + 0.8/nu and
// y < y_0. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// dp/dS = tr(S)^2 I - S^2 for the product p of the sums of two eigenvalues of S.
  template <typename Number>
  Matrix3<Number>
  p_derivative(const Matrix3<Number> &S)
  {
    const Number    I_1 = trace(S);
    Matrix3<Number> D   = S * S;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        D[i][j] = (i == j ? I_1 * I_1 : Number(0.)) - D[i][j];
    return D;
  }

  /// The change of p_derivative() by a change dS of S.
  template <typename Number>
  Matrix3<Number>
  p_second_derivative(const Matrix3<Number> &S, const Matrix3<Number> &dS)
  {
    const Number          change_of_square = Number(2.) * trace(S) * trace(dS);
    const Matrix3<Number> SdS              = S * dS;
    Matrix3<Number>       dD;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        dD[i][j] = (i == j ? change_of_square : Number(0.)) - SdS[i][j] - SdS[j][i];
    return dD;
  }

  /// The function r of Eq. (24) and its derivatives by y, for y < y_0. y = p / |F|^2 is 8/3 at rest
  /// and about s_2 + s_3 where that vanishes.
  template <typename Number>
  struct NearKink
  {
    static constexpr double y_0 = 0.4;

    NearKink() = default;

    explicit NearKink(const Number &y)
    {
      const Number z = Number(1.) - y / Number(y_0);
      value          = Number(y_0 / 3.) * z * z * z;
      first          = -z * z;
      second         = Number(2. / y_0) * z;
    }

    Number value, first, second;
  };

  /// dy/dS, where u = |F|^2.
  template <typename Number>
  Matrix3<Number>
  y_derivative_of(const Matrix3<Number> &S, const Number &y, const Number &u)
  {
    return combine(Number(1.) / u, p_derivative(S), Number(-2.) * y / u, S);
  }

  /// The change of y_derivative_of() = (dp/dS - 2 y S) / |F|^2 by a change dS of S.
  template <typename Number>
  Matrix3<Number>
  y_second_derivative(const Matrix3<Number> &S,
                      const Number          &y,
                      const Number          &norm,
                      const Matrix3<Number> &y_derivative,
                      const Matrix3<Number> &dS)
  {
    const Number          d_norm = contract(S, dS) / norm;
    const Number          dy     = contract(y_derivative, dS);
    const Matrix3<Number> dD     = p_second_derivative(S, dS);
    Matrix3<Number>       change;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        change[i][j] = ((dD[i][j] - Number(2.) * (dy * S[i][j] + y * dS[i][j])) / norm
                        - Number(2.) * d_norm * y_derivative[i][j])
                       / norm;
    return change;
  }

  /// The guard of stretched cells, Gamma of Eq. (24), and its derivatives.
  template <typename Number>
  class StretchGuard
  {
  public:
    /// The inactive guard of an undeformed cell.
    StretchGuard() = default;

    /// `p` is the product of the sums of two eigenvalues of S.
    StretchGuard(const CellMaterial<Number> &material, const Matrix3<Number> &S, const Number &p)
        : S(S)
    {
      const Number            square = contract(S, S);
      const KinkSlope<Number> kink   = kink_slope(material, sqrt(square));
      const Number            rise   = kink.slope + kink.margin;
      is_acting                      = (p < Number(y_0) * square) & (rise > Number(0.));
      if (!any(is_acting))
        return;
      // another lane may be a cell collapsed to F = 0, where the ratios would be 0 / 0
      const Number u = select(is_acting, square, Number(1.));
      norm           = sqrt(u);
      y              = select(is_acting, p / u, Number(y_0));
      // 4 q = (c + m)^2 / m for |c| < m, then 4 c
      const auto is_beyond = kink.slope >= kink.margin;
      const auto keep = [&](const Number &number) { return select(is_acting, number, Number(0.)); };
      q[0]            = keep(select(is_beyond, Number(4.) * kink.slope, rise * rise / kink.margin));
      q[1] = keep(select(is_beyond, Number(4.), Number(2.) * rise / kink.margin)) * kink.by_norm;
      q[2] = keep(select(is_beyond, Number(0.), Number(2.) / kink.margin)) * kink.by_norm
             * kink.by_norm;
      r            = NearKink<Number>(y);
      y_derivative = y_derivative_of(S, y, u);
    }

    /// Whether y < y_0 in some lane, a necessary condition for the guard to act.
    static bool
    may_act(const Matrix3<Number> &S, const Number &p)
    {
      const Number diagonal = S[0][0] * S[0][0] + S[1][1] * S[1][1] + S[2][2] * S[2][2];
      const Number beside   = S[0][1] * S[0][1] + S[1][2] * S[1][2] + S[2][0] * S[2][0];
      return any(p < Number(y_0) * (diagonal + beside + beside));
    }

    /// Whether the guard acts in some lane.
    bool
    acts() const
    {
      return any(is_acting);
    }

    /// The energy density Gamma [Pa], where the guard acts.
    Number
    energy() const
    {
      return q[0] * r.value;
    }

    /// Gamma [Pa]; 0 where it does not act.
    Number
    energy_or_zero() const
    {
      return acts() ? energy() : Number(0.);
    }

    /// R^T dGamma/dF, where the guard acts.
    Matrix3<Number>
    force() const
    {
      return combine(q[1] * r.value / norm, S, q[0] * r.first, y_derivative);
    }

    /// The change of force() by a change dS of S, where the guard acts.
    Matrix3<Number>
    response(const Matrix3<Number> &dS) const
    {
      const Number          d_norm       = contract(S, dS) / norm;
      const Number          dy           = contract(y_derivative, dS);
      const Matrix3<Number> d_derivative = y_second_derivative(S, y, norm, y_derivative, dS);
      const Number          a            = q[1] * r.value / norm; // force() is a S + b y_derivative
      const Number          b            = q[0] * r.first;
      const Number da = (q[2] * r.value * d_norm + q[1] * r.first * dy - a * d_norm) / norm;
      const Number db = q[1] * r.first * d_norm + q[0] * r.second * dy;
      const Matrix3<Number> of_factors = combine(da, S, db, y_derivative);
      const Matrix3<Number> of_vectors = combine(a, dS, b, d_derivative);
      return combine(Number(1.), of_factors, Number(1.), of_vectors);
    }

  private:
    static constexpr double y_0 = NearKink<Number>::y_0;

    using Mask = decltype(Number() < Number());

    Mask             is_acting = Number(0.) > Number(0.);
    Matrix3<Number>  S;
    Number           norm; ///< |F|
    Number           y;
    Number           q[3]; ///< 4 q and its derivatives by |F|
    NearKink<Number> r;
    Matrix3<Number>  y_derivative; ///< dy/dS
  };
} // namespace Exemplar

#endif
