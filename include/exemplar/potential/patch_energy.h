// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_patch_energy_h
#define exemplar_patch_energy_h

#include <exemplar/kernels/patch_cell.h>

#include <algorithm>

// The energy densities of a patch as functions of means over its points, and their derivatives, for
// double and for numbers with derivatives.

namespace Exemplar
{
  /// lambda/2 (theta - D)^2 of a mean theta and its target D, Eq. (25).
  template <typename Number>
  Number
  energy_of_mean(const Number &lambda, const Number &theta, const Number &D)
  {
    const Number deviation = theta - D;
    return Number(0.5) * lambda * deviation * deviation;
  }

  /// Its derivative by theta, where theta^2 has a share of the energy, Eq. (37). That by D is minus
  /// this with the share 1.
  template <typename Number>
  Number
  pressure_of_mean(const Number &lambda, const Number &share, const Number &theta, const Number &D)
  {
    return lambda * (share * theta - D);
  }

  /// Xi of Eq. (26), or its mean over a patch, by the square of the trace's difference from
  /// theta_p and Gamma.
  template <typename Number>
  Number
  energy_of_guard(const Number &lambda, const Number &square, const Number &gamma)
  {
    return Number(0.5) * lambda * square + gamma;
  }

  /// beta = z^3 (10 - 15 z + 6 z^2) of Eq. (26) for the mean m of |F|^2.
  template <typename Number>
  class GuardTransition
  {
  public:
    /// beta is 0 for m up to `bound`.
    GuardTransition(const Number &m, const Number &bound)
        : range(Number(0.3) * bound),
          z(std::clamp(Number((m - bound) / range), Number(0.), Number(1.)))
    {
    }

    Number
    value() const
    {
      return z * z * z * (Number(10.) - Number(15.) * z + Number(6.) * z * z);
    }

    /// The derivative by m.
    Number
    first() const
    {
      return Number(30.) * z * z * (Number(1.) - z) * (Number(1.) - z) / range;
    }

    /// The second derivative by m.
    Number
    second() const
    {
      return Number(60.) * z * (Number(1.) - z) * (Number(1.) - Number(2.) * z) / (range * range);
    }

  private:
    Number range, z;
  };

  /// The bound of the guard of a patch whose examples have at most this mean of |F|^2.
  template <typename Number>
  Number
  bound_of_guard(const Number &greatest)
  {
    using std::max;
    return max(Number(min_stretched_square), Number(1.2) * greatest);
  }
} // namespace Exemplar

#endif
