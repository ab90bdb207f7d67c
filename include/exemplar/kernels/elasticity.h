// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_elasticity_h
#define exemplar_elasticity_h

#include <exemplar/kernels/matrix3.h>
#include <exemplar/kernels/model_traits.h>

#include <array>

// Lamé's constants, which every law has, under the name CellMaterial. A law with further ones has
// its own Constants with the members of Isotropic. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// C:E = lambda tr(E) I + 2 mu E, Eq. (3), with Lamé's constants [Pa].
  template <typename Number>
  struct Isotropic
  {
    /// Whether C:E has the principal axes of E: then W of Eq. (17) is 0 without a target, and
    /// rotating C is the same as rotating the shape gradients of a cell.
    static constexpr bool is_isotropic = true;

    /// Number of constants stored for each point: these two, then those of `own_constants`.
    static constexpr std::size_t n_numbers = 2;

    static constexpr std::array<LawConstant, 0> own_constants{};

    Number lambda;
    Number mu;

    /// Make it from load(k), which returns number k.
    template <typename Load>
    static Isotropic
    from_numbers(const Load &load)
    {
      return { load(0), load(1) };
    }

    const Number &
    number(const std::size_t k) const
    {
      return k == 0 ? lambda : mu;
    }

    /// The material whose C is `factor` times this one's.
    Isotropic
    scaled(const Number &factor) const
    {
      return { factor * lambda, factor * mu };
    }

    /// The material without the volume part, which is a patch's, Eq. (25).
    Isotropic
    without_dilatation() const
    {
      return { Number(0.), mu };
    }

    /// The isotropic part of C, which the guards use.
    const Isotropic &
    isotropic_part() const
    {
      return *this;
    }

    /// The material with `factor` times its anisotropic part.
    const Isotropic &
    softened(const Number & /*factor*/) const
    {
      return *this;
    }

    /// An estimate of the norm of C [Pa], the amplification of a strain's rounding in its stress.
    Number
    norm_estimate() const
    {
      return abs(lambda) + Number(2.) * mu;
    }
  };

  template <typename Number>
  using CellMaterial = Isotropic<Number>;

  /// The material of Young's modulus E [Pa] and Poisson's ratio nu.
  template <typename Number>
  Isotropic<Number>
  isotropic_of(const Number &E, const Number &nu)
  {
    const Number one(1.), two(2.);
    return { E * nu / ((one + nu) * (one - two * nu)), E / (two * (one + nu)) };
  }

  /// C:E [Pa].
  template <typename Number>
  [[gnu::always_inline]] inline Matrix3<Number>
  stress(const Isotropic<Number> &material, const Matrix3<Number> &strain)
  {
    const Number    pressure = material.lambda * trace(strain);
    Matrix3<Number> T;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        T[i][j] = Number(2.) * material.mu * strain[i][j] + (i == j ? pressure : Number(0.));
    return T;
  }

  /// The target strain D' of a cell with stiffness damping. The energies of elasticity and of
  /// damping are 1/2 (e-D):C:(e-D) and s/2 (e-e*):C:(e-e*). Up to a constant their sum is (1+s)/2
  /// (e-D'):C:(e-D') with D' = (D + s e*) / (1+s).
  template <typename Number>
  Matrix3<Number>
  damped_target(const Matrix3<Number> &target, const Number &s, const Matrix3<Number> &past)
  {
    const Number factor = Number(1.) / (Number(1.) + s);
    return combine(factor, target, factor * s, past);
  }

  // The guard of Eq. (16) removes the part of the energy that would jump where the rotation is
  // ambiguous: with a factor 1 - phi it adds S : dev(C:D), for the stretch S and the target strain
  // D. The three functions below are this term and its derivatives; here dev(C:D) = 2 mu dev D. For
  // anisotropic materials see grain_cell.h.

  /// factor S : dev(C:D) [Pa].
  template <typename Number>
  Number
  guard_energy(const Isotropic<Number> &material,
               const Number            &factor,
               const Matrix3<Number>   &S,
               const Matrix3<Number>   &D)
  {
    return Number(2.) * material.mu * factor * contract(S, deviator(D));
  }

  /// T + factor dev(C:D), the derivative of the guard's energy by S added to a stress T [Pa];
  /// e = S - I.
  template <typename Number>
  Matrix3<Number>
  add_guard_of_target(const Matrix3<Number>   &T,
                      const Isotropic<Number> &material,
                      const Number            &factor,
                      const Matrix3<Number> & /*e*/,
                      const Matrix3<Number> &D)
  {
    return combine(Number(1.), T, Number(2.) * material.mu * factor, deviator(D));
  }

  /// T + factor C:dev(S), the derivative by D [Pa].
  template <typename Number>
  Matrix3<Number>
  add_guard_of_stretch(const Matrix3<Number>   &T,
                       const Isotropic<Number> &material,
                       const Number            &factor,
                       const Matrix3<Number>   &S)
  {
    return combine(Number(1.), T, Number(2.) * material.mu * factor, deviator(S));
  }

  /// Slope of the energy across the kink of stretch_guard.h, in a material.
  template <typename Number>
  struct KinkSlope
  {
    Number slope;   ///< c(|F|), an upper bound of the slope across the kink [Pa]
    Number by_norm; ///< its derivative by |F| [Pa]
    Number margin;  ///< the guard begins where `slope` is minus this [Pa]
  };

  /// The slope at the kink, where tr S = s_1 <= |F|; with this margin the guard begins at
  /// |F| = 1 + 0.8/nu.
  template <typename Number>
  KinkSlope<Number>
  kink_slope(const Isotropic<Number> &material, const Number &norm)
  {
    return { material.lambda * (norm - Number(3.)) - Number(2.) * material.mu, material.lambda,
             Number(0.4) * (material.lambda + material.mu) };
  }

  /// An energy density of the elasticity [Pa] below which the guard of the stretch does not act:
  /// |F| > 1 + 0.8/nu > 2.6 implies |S - I|^2 > (2.6 - sqrt(3))^2 > 0.75. For nu <= 0, where the
  /// energy may be less than mu |S - I|^2, the guard never acts.
  template <typename Number>
  Number
  min_density_at_kink(const Isotropic<Number> &material)
  {
    return Number(0.75) * material.mu;
  }
} // namespace Exemplar

#endif
