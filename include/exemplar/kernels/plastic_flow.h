// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_plastic_flow_h
#define exemplar_plastic_flow_h

#include <exemplar/kernels/elasticity.h>

#include <array>

// The plastic strain p of a cell at the end of a step that begins with p_n and the accumulated
// strain a_n: the minimiser, over all trace-free p with sqrt(2/3) |p| <= m, of the incremental
// energy, Eq. (32),
//
//   mu |d - p|^2 + H_k/3 |p|^2 + H_i/2 a^2 + sqrt(2/3) sigma_y g + v/2 g^2,
//
// with g = |p - p_n| (Delta in Eq. (32)), a = a_n + sqrt(2/3) g, the deviator d of the strain, and
// v the viscosity over the step size. Where the bound m is inactive this is the radial return. No
// deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// Lamé's constants and those of Eq. (32).
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

  /// The plastic strain of a cell at the end of a step, and its response to the strain.
  template <typename Number>
  class PlasticFlow
  {
  public:
    /// No plastic strain.
    PlasticFlow() = default;

    /// Compute the flow from the plastic strain p_n and the accumulated strain a_n, in a step of
    /// this size [s]; 0: outside of steps, where nothing flows.
    PlasticFlow(const PlasticConstants<Number> &constants,
                const Matrix3<Number>          &d,
                const Matrix3<Number>          &p_n,
                const Number                   &a_n,
                const double                    step_size)
    {
      begin(constants, d, p_n, a_n, step_size);
    }

    /// Whether d causes flow where there is no plastic strain yet, for each lane.
    static auto
    begins(const PlasticConstants<Number> &constants, const Matrix3<Number> &d)
    {
      const Number two_mu = Number(2.) * constants.mu,
                   yield  = Number(root) * constants.yield_stress;
      return two_mu * two_mu * contract(d, d) > yield * yield;
    }

    /// Compute the flow as the constructor does, on a default object.
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
      // the relative stress that drives the flow
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

    /// The plastic strain p.
    const Matrix3<Number> &
    strain() const
    {
      return p;
    }

    /// The accumulated plastic strain a.
    const Number &
    accumulated() const
    {
      return a;
    }

    /// The potential of the flow, sqrt(2/3) sigma_y g + v/2 g^2 [Pa].
    Number
    dissipation_potential() const
    {
      return (yield + Number(0.5) * v * g) * g;
    }

    /// The dissipated energy density, sqrt(2/3) sigma_y g + v g^2 [Pa].
    Number
    dissipation() const
    {
      return (yield + v * g) * g;
    }

    /// The derivative dp/dd times dd; a symmetric operator with eigenvalues in [0, 1].
    Matrix3<Number>
    response(const Matrix3<Number> &dd) const
    {
      if (!is_flowing)
        return Matrix3<Number>{};
      const Matrix3<Number> dp = inverse_times(combine(two_mu, dd, Number(0.), dd));
      if (!any(multiplier > Number(0.)))
        return dp;
      // |p| is fixed at its bound
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
      p[2][2]          = -(p[0][0] + p[1][1]); // as restored from the history
      a += Number(root) * g;
    }

    /// The inverse Hessian of the incremental energy by p, times X.
    Matrix3<Number>
    inverse_times(const Matrix3<Number> &X) const
    {
      return combine(turning, X, (stretching - turning) * contract(n, X), n);
    }

    /// |p| and its scaled derivative p:dp/dk < 0 at a multiplier k.
    struct Length
    {
      Number value, slope;
    };

    /// |p| at the multiplier k, from |xi|^2, xi:p_n and |p_n|^2, with xi at k = 0.
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

    /// Find the multiplier k of the bound |p| <= `maximum`, with force k p: |p| decreases with k.
    /// Newton's method on 1/|p|, which is nearly linear in k, safeguarded by bisection.
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
    Number          threshold  = Number(0.); ///< yield plus isotropic hardening, before the flow
    Number          modulus    = Number(1.); ///< decrease of |xi| for a unit of flow
    Number          size       = Number(1.); ///< |xi|
    Number          multiplier = Number(0.);
    Number          g          = Number(0.);
    bool            is_flowing = false;      ///< whether some lane flows
    Matrix3<Number> n;                       ///< direction of the flow
    Number          turning    = Number(0.); ///< eigenvalue of inverse_times() normal to n
    Number          stretching = Number(0.); ///< eigenvalue along n
  };
} // namespace Exemplar

#endif
