// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_grain_cell_h
#define exemplar_grain_cell_h

#include <exemplar/kernels/corotational_cell.h>
#include <exemplar/kernels/symmetric.h>

// Corotational cells of anisotropic materials, C = C_iso + C_a: fibres, or any symmetric C.
// Material axes are those of the rest pose, so that C is in the frame of the cell's rotation. Where
// the rotation is ambiguous S itself jumps, so the guard phi multiplies all terms of C_a with S,
// where e = S - I:
//
//   psi = 1/2 (e - D):C:(e - D) + (1 - phi) (2 mu S : dev D - 1/2 e:C_a:(e - 2 D)),   Eq. (16)
//
// The term 1/2 D:C_a:D is not guarded, so that the second derivative by D stays constant. No
// deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// Fibres in an isotropic material, which add alpha/2 (a.e a)^2 to 1/2 e:C:e.
  template <typename Number>
  struct Fibrous
  {
    static constexpr const char *name         = "fibrous";
    static constexpr bool        is_isotropic = false;

    static constexpr std::size_t n_numbers = 6;

    static constexpr std::array<LawConstant, 1> own_constants = {
      { { "Fibre stiffness",
          "alpha [Pa]: what fibres along Fibre direction add to Young's modulus of a stretch along "
          "them. The energy density has alpha/2 (a.e a)^2 more for a strain e and the "
          "direction a, of the body and of its examples. For the corotational strain with "
          "consistent forces.",
          0. } }
    };

    Number          lambda;
    Number          mu;
    Number          alpha;
    Vector3<Number> a; ///< unit vector

    template <typename Load>
    static Fibrous
    from_numbers(const Load &load)
    {
      return { load(0), load(1), load(2), { { load(3), load(4), load(5) } } };
    }

    Fibrous
    scaled(const Number &factor) const
    {
      return { factor * lambda, factor * mu, factor * alpha, a };
    }

    Isotropic<Number>
    isotropic_part() const
    {
      return { lambda, mu };
    }

    Fibrous
    softened(const Number &factor) const
    {
      return { lambda, mu, factor * alpha, a };
    }

    /// min_density_at_kink() for any phi; `undamped` is the isotropic part without damping.
    Number
    min_density(const Isotropic<Number> &undamped) const
    {
      return min_density_at_kink(undamped);
    }
  };

  /// C_a:E [Pa].
  template <typename Number>
  [[gnu::always_inline]] inline Matrix3<Number>
  anisotropic_stress(const Fibrous<Number> &material, const Matrix3<Number> &E)
  {
    const Vector3<Number> &a       = material.a;
    const Number           tension = material.alpha * dot(a, E * a);
    Matrix3<Number>        T;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        T[i][j] = tension * (a[i] * a[j]);
    return T;
  }

  /// C:E [Pa].
  template <typename Number>
  [[gnu::always_inline]] inline Matrix3<Number>
  stress(const Fibrous<Number> &material, const Matrix3<Number> &E)
  {
    return combine(Number(1.), stress(material.isotropic_part(), E), Number(1.),
                   anisotropic_stress(material, E));
  }

  /// Any positive definite C: orthotropy, with fibres or without.
  template <typename Number>
  struct Anisotropic
  {
    static constexpr const char *name         = "anisotropic";
    static constexpr bool        is_isotropic = false;

    static constexpr std::size_t n_entries = 21; ///< entries of the symmetric 6 x 6 matrix of C
    static constexpr std::size_t n_numbers = 3 + n_entries;

    static constexpr std::array<LawConstant, 0> own_constants{};

    Number lambda, mu;       ///< Lamé's constants of C_iso, the isotropic material nearest to C
    Number least;            ///< half the least eigenvalue of C, without damping
    Number entry[n_entries]; ///< rows of the upper triangle of C, in the order of SymmetricEntries

    template <typename Load>
    static Anisotropic
    from_numbers(const Load &load)
    {
      Anisotropic C;
      C.lambda = load(0);
      C.mu     = load(1);
      C.least  = load(2);
      for (std::size_t k = 0; k < n_entries; ++k)
        C.entry[k] = load(3 + k);
      return C;
    }

    Anisotropic
    scaled(const Number &factor) const
    {
      Anisotropic C = *this;
      C.lambda *= factor;
      C.mu *= factor;
      for (Number &number : C.entry)
        number *= factor;
      return C;
    }

    Isotropic<Number>
    isotropic_part() const
    {
      return { lambda, mu };
    }

    Anisotropic
    softened(const Number &factor) const
    {
      if (!any(factor < Number(1.)))
        return *this;
      Anisotropic  C    = *this;
      const Number rest = Number(1.) - factor;
      std::size_t  k    = 0;
      for (std::size_t i = 0; i < n_symmetric; ++i)
        for (std::size_t j = i; j < n_symmetric; ++j, ++k)
        {
          C.entry[k] *= factor;
          if (j < 3)
            C.entry[k] += rest * (i == j ? lambda + Number(2.) * mu : lambda);
          else if (i == j)
            C.entry[k] += rest * mu;
        }
      return C;
    }

    /// min_density_at_kink() for any phi.
    Number
    min_density(const Isotropic<Number> & /*undamped*/) const
    {
      return Number(0.75) * least;
    }
  };

  /// C:E [Pa].
  template <typename Number>
  [[gnu::always_inline]] inline Matrix3<Number>
  stress(const Anisotropic<Number> &material, const Matrix3<Number> &E)
  {
    SymmetricEntries<Number> of_E = pack(E), T;
    for (std::size_t k = 3; k < n_symmetric; ++k)
      of_E[k] += of_E[k]; // C contracts each shear twice
    for (Number &entry : T.value)
      entry = Number(0.);
    std::size_t k = 0;
    for (std::size_t i = 0; i < n_symmetric; ++i)
      for (std::size_t j = i; j < n_symmetric; ++j, ++k)
      {
        T[i] += material.entry[k] * of_E[j];
        if (i != j)
          T[j] += material.entry[k] * of_E[i];
      }
    return unpack(T);
  }

  /// C_a:E [Pa].
  template <typename Number>
  Matrix3<Number>
  anisotropic_stress(const Anisotropic<Number> &material, const Matrix3<Number> &E)
  {
    return combine(Number(1.), stress(material, E), Number(-1.),
                   stress(material.isotropic_part(), E));
  }

  // The guard of Eq. (16), as elasticity.h has it for isotropic materials.

  /// Energy of the guard, factor (2 mu S : dev D - 1/2 e:C_a:(e - 2 D)) [Pa].
  template <typename Number, template <typename> class Grain>
  Number
  guard_energy(const Grain<Number>   &material,
               const Number          &factor,
               const Matrix3<Number> &S,
               const Matrix3<Number> &D)
  {
    const Matrix3<Number> e = combine(Number(1.), S, Number(-1.), identity_matrix<Number>());
    return guard_energy(material.isotropic_part(), factor, S, D)
           - Number(0.5) * factor
                 * contract(anisotropic_stress(material, e),
                            combine(Number(1.), e, Number(-2.), D));
  }

  /// T plus the derivative of the guard's energy by S [Pa].
  template <typename Number, template <typename> class Grain>
  Matrix3<Number>
  add_guard_of_target(const Matrix3<Number> &T,
                      const Grain<Number>   &material,
                      const Number          &factor,
                      const Matrix3<Number> &e,
                      const Matrix3<Number> &D)
  {
    if (!any(factor * factor > Number(0.))) // the guard does not act, as in nearly all cells
      return T;
    const Matrix3<Number> of_grain
        = anisotropic_stress(material, combine(Number(1.), e, Number(-1.), D));
    return combine(Number(1.), add_guard_of_target(T, material.isotropic_part(), factor, e, D),
                   -factor, of_grain);
  }

  /// T plus the derivative of the guard's energy by D [Pa].
  template <typename Number, template <typename> class Grain>
  Matrix3<Number>
  add_guard_of_stretch(const Matrix3<Number> &T,
                       const Grain<Number>   &material,
                       const Number          &factor,
                       const Matrix3<Number> &S)
  {
    const Matrix3<Number> e = combine(Number(1.), S, Number(-1.), identity_matrix<Number>());
    return combine(Number(1.), add_guard_of_stretch(T, material.isotropic_part(), factor, S),
                   factor, anisotropic_stress(material, e));
  }

  /// Traits of a law under another name, which keys of Material choose.
  constexpr ModelTraits
  with_name(ModelTraits traits, const char *name)
  {
    traits.name   = name;
    traits.strain = "";
    return traits;
  }

  /// A deformed cell; see CorotationalCell.
  template <typename Number, template <typename> class Grain>
  class GrainCell : public CorotationalCell<Number, Grain<Number>>
  {
    using Corotational = CorotationalCell<Number, Grain<Number>>;

  public:
    static constexpr ModelTraits traits = with_name(Corotational::traits, Grain<Number>::name);

    using Corotational::Corotational;

    /// Necessary condition for the guard of the stretch to act in some lane, by the energy density
    /// of the elasticity [Pa].
    bool
    may_be_stretched(const Number &elastic_density) const
    {
      return any(elastic_density > this->own_material().min_density(this->elasticity));
    }
  };

  template <typename Number>
  using FibrousCell = GrainCell<Number, Fibrous>;

  template <typename Number>
  using AnisotropicCell = GrainCell<Number, Anisotropic>;
} // namespace Exemplar

#endif
