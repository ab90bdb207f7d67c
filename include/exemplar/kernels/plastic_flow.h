// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_plastic_flow_h
#define exemplar_plastic_flow_h

#include <exemplar/kernels/elasticity.h>

#include <array>

// The plastic strain p of a cell at the end of a step that begins with p_n and the accumulated strain a_n:
// the least, over all p without trace and of sqrt(2/3) |p| <= m, of the incremental energy, Eq. (32),
//
//   mu |d - p|^2 + H_k/3 |p|^2 + H_i/2 a^2 + sqrt(2/3) sigma_y g + v/2 g^2,
//
// with g = |p - p_n|, there Delta, a = a_n + sqrt(2/3) g, the deviator d of the strain, and the viscosity v over the time
// step. Where m does not act this is the radial return. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// Those of Eq. (32), beside Lamé's constants.
  template <typename Number>
  struct PlasticConstants : Isotropic<Number>
  {
    static constexpr std::size_t n_numbers = 7;

    static constexpr std::array<LawConstant, 5> own_constants = {
      { { "Yield stress",
          "sigma_y [Pa], in tension: cells in which the stress of von Mises reaches it keep a part "
          "of their "
          "strain. 0: they never do. Fibres do not yield, and see the whole strain.",
          0. },
        { "Kinematic hardening",
          "H_k [Pa]: with the plastic strain the stress around which a cell yields moves; in "
          "tension by H_k for a unit of it. Where there is a Yield stress.",
          0. },
        { "Isotropic hardening",
          "H_i [Pa]: the yield stress grows by this for a unit of accumulated plastic strain. "
          "Where there is a Yield stress.",
          0. },
        { "Flow viscosity",
          "[Pa s]: plastic strain grows by what the stress exceeds the yield stress over this in a "
          "second; 0: at once. Where there is a Yield stress, in dynamic scenes.",
          0. },
        { "Greatest plastic strain",
          "m [-], in tension: beyond it a cell keeps no more strain. At most 0.95, because a cell "
          "that stays squeezed by 1 would be flat. Where there is a Yield stress.",
          0.9, 1e-6, 0.95 } }
    };

    Number yield_stress, kinematic, isotropic, viscosity, greatest;

    template <typename Load>
    static PlasticConstants
    from_numbers(const Load &load)
    {
      return { { load(0), load(1) }, load(2), load(3), load(4), load(5), load(6) };
    }
  };

  /// The plastic strain of a cell at the end of a step, and how it follows the strain.
  template <typename Number>
  class PlasticFlow
  {
  public:
    /// Nothing has flown.
    PlasticFlow() = default;

    /// From the plastic strain p_n and the accumulated one in a step of that size [s]: 0: none, in which
    /// nothing flows.
    PlasticFlow(const PlasticConstants<Number> &constants,
                const Matrix3<Number>          &d,
                const Matrix3<Number>          &p_n,
                const Number                   &a_n,
                const double                    step_size)
    {
      begin(constants, d, p_n, a_n, step_size);
    }

    /// Whether d lets something flow where nothing has flown before, for each lane.
    static auto
    begins(const PlasticConstants<Number> &constants, const Matrix3<Number> &d)
    {
      const Number two_mu = Number(2.) * constants.mu,
                   yield  = Number(root) * constants.yield_stress;
      return two_mu * two_mu * contract(d, d) > yield * yield;
    }

    /// As the constructor, where nothing has flown.
    void
    begin(const PlasticConstants<Number> &constants,
          const Matrix3<Number>          &d,
          const Matrix3<Number>          &p_n,
          const Number                   &a_n,
          const double                    step_size)
    {
      p      = p_n;
      a      = a_n;
      two_mu = Number(2.) * constants.mu;
      if (!(step_size > 0.))
        return;
      v                 = constants.viscosity * Number(1. / step_size);
      yield             = Number(root) * constants.yield_stress;
      threshold         = yield + Number(root) * constants.isotropic * a;
      const Number of_p = two_mu + Number(2. / 3.) * constants.kinematic;
      modulus           = of_p + Number(2. / 3.) * constants.isotropic + v;
      // the stress that drives the flow
      Matrix3<Number> xi = combine(two_mu, d, -of_p, p);
      size               = at_least_tiny(norm(xi));
      if (!any(size > threshold))
        return;
      const Number maximum = constants.greatest * Number(1. / root);
      find_multiplier(xi, maximum);
      if (any(multiplier > Number(0.)))
      {
        xi   = combine(Number(1.), xi, -multiplier, p);
        size = at_least_tiny(norm(xi));
      }
      flow_along(xi);
    }

    /// p.
    const Matrix3<Number> &
    strain() const
    {
      return p;
    }

    /// a.
    const Number &
    accumulated() const
    {
      return a;
    }

    /// sqrt(2/3) sigma_y g + v/2 g^2 [Pa].
    Number
    dissipation_potential() const
    {
      return (yield + Number(0.5) * v * g) * g;
    }

    /// sqrt(2/3) sigma_y g + v g^2 [Pa].
    Number
    dissipation() const
    {
      return (yield + v * g) * g;
    }

    /// The change of p with d; symmetric, and between 0 and 1.
    Matrix3<Number>
    response(const Matrix3<Number> &dd) const
    {
      if (!is_flowing)
        return Matrix3<Number>{};
      const Matrix3<Number> dp = inverse_times(combine(two_mu, dd, Number(0.), dd));
      if (!any(multiplier > Number(0.)))
        return dp;
      // |p| stays
      const Matrix3<Number> w     = inverse_times(p);
      const Number          along = contract(p, w);
      const Number          part  = select((multiplier > Number(0.)) & (along > Number(0.)),
                                           two_mu * contract(w, dd) / max(along, Number(1e-300)), Number(0.));
      return combine(Number(1.), dp, -part, w);
    }

  private:
    static constexpr double root = 0.81649658092772603; ///< sqrt(2/3)

    static Number
    at_least_tiny(const Number &number)
    {
      return max(number, Number(1e-300));
    }

    void
    flow_along(const Matrix3<Number> &xi)
    {
      is_flowing       = true;
      const auto flows = size > threshold;
      n                = combine(Number(1.) / size, xi, Number(0.), xi);
      g                = max(size - threshold, Number(0.)) / (modulus + multiplier);
      turning          = g / size;
      stretching       = select(flows, Number(1.) / (modulus + multiplier), Number(0.));
      p                = combine(Number(1.), p, g, n);
      p[2][2]          = -(p[0][0] + p[1][1]); // as it is remembered
      a += Number(root) * g;
    }

    /// The inverse of the second derivative of the energy by p, times X.
    Matrix3<Number>
    inverse_times(const Matrix3<Number> &X) const
    {
      return combine(turning, X, (stretching - turning) * contract(n, X), n);
    }

    /// |p| and p:(its change with the multiplier), less than 0, for one multiplier.
    struct Length
    {
      Number value, slope;
    };

    /// From |xi|^2, xi:p_n and |p_n|^2 without a multiplier.
    Length
    length(const Number &k, const Number &xi_xi, const Number &xi_p, const Number &p_p) const
    {
      const Number along = xi_p - k * p_p; // xi:p_n
      const Number of_xi
          = at_least_tiny(sqrt(max(xi_xi - Number(2.) * k * xi_p + k * k * p_p, Number(0.))));
      const Number flow   = max(of_xi - threshold, Number(0.)) / (modulus + k);
      const Number square = p_p + Number(2.) * flow * along / of_xi + flow * flow;
      const Number n_p    = along / of_xi + flow;
      const Number slope  = flow / of_xi * max(square - n_p * n_p, Number(0.))
                           + select(of_xi > threshold, n_p * n_p / (modulus + k), Number(0.));
      return { sqrt(max(square, Number(0.))), -slope };
    }

    /// The force k p that keeps |p| at most at `maximum`: |p| falls with k. Newton's method on 1/|p|, which
    /// is nearly linear in k, between bounds that close in.
    void
    find_multiplier(const Matrix3<Number> &xi, const Number &maximum)
    {
      const Number xi_xi = contract(xi, xi), xi_p = contract(xi, p), p_p = contract(p, p);
      const Number tolerance = Number(4e-15) * maximum;
      const Number zero      = Number(0.);
      const auto   acts
          = (size > threshold) & (length(zero, xi_xi, xi_p, p_p).value > maximum + tolerance);
      if (!any(acts))
        return;
      // p = (q - threshold n) / (modulus + k) with q = xi + modulus p_n
      const Number q     = norm(combine(Number(1.), xi, modulus, p));
      Number       lower = max((q - threshold) / maximum - modulus, zero);
      Number       upper = max((q + threshold) / maximum - modulus, zero);
      Number       k     = lower;
      for (int iteration = 0; iteration < 60; ++iteration)
      {
        const Length at       = length(k, xi_xi, xi_p, p_p);
        const auto   is_above = at.value > maximum + tolerance;
        const auto   is_below = at.value < maximum - tolerance;
        if (!any(acts & (is_above | is_below)))
          break;
        lower               = select(is_above, k, lower);
        upper               = select(is_below, k, upper);
        const Number newton = k
                              + (at.value - maximum) * at.value * at.value
                                    / (maximum * max(-at.slope, Number(1e-300)));
        const auto is_inside = (newton > lower) & (newton < upper);
        k = select(is_above | is_below, select(is_inside, newton, Number(0.5) * (lower + upper)),
                   k);
      }
      multiplier = select(acts, k, zero);
    }

    Matrix3<Number> p{};
    Number          a          = Number(0.);
    Number          two_mu     = Number(0.);
    Number          v          = Number(0.);
    Number          yield      = Number(0.); ///< sqrt(2/3) sigma_y
    Number          threshold  = Number(0.); ///< the same with hardening, before the flow
    Number          modulus    = Number(1.); ///< by which |xi| falls for a unit of flow
    Number          size       = Number(1.); ///< |xi|
    Number          multiplier = Number(0.);
    Number          g          = Number(0.);
    bool            is_flowing = false;      ///< some lane
    Matrix3<Number> n;                       ///< direction of the flow, if there is one
    Number          turning    = Number(0.); ///< eigenvalues of inverse_times() across n
    Number          stretching = Number(0.); ///< and along it
  };
} // namespace Exemplar

#endif
