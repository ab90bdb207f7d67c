// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_quadratic_cell_h
#define exemplar_quadratic_cell_h

#include <exemplar/kernels/elasticity.h>
#include <exemplar/kernels/model_traits.h>
#include <exemplar/kernels/stretch_guard.h>
#include <exemplar/kernels/tetrahedron.h>

// The common base of all laws. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// A deformed cell of energy density 1/2 (e - D) : C : (e - D) with a strain e that is a function
  /// of F alone, and a target strain D. A law adds the forces and their responses, in the frame of
  /// its rotation: R^T P for the first Piola-Kirchhoff stress P. CorotationalCell has all members.
  template <typename Number, typename OfLaw = CellMaterial<Number>>
  class QuadraticCell
  {
  public:
    using Constants = OfLaw;

    static constexpr std::array<Refusal, 0> refusals{};

    /// The change of e by a change dF of F, for a fixed rotation.
    static Matrix3<Number>
    strain_change(const Matrix3<Number> &rotation,
                  const Matrix3<Number> & /*deformation_gradient*/,
                  const Matrix3<Number> &dF)
    {
      return symmetric_part(transpose_times(rotation, dF));
    }

    /// Whether the guard of Eq. (16) acts, for each lane.
    auto
    is_guarded() const
    {
      return Number(0.) > Number(1.); // false in every lane
    }

    /// Energy density of the elasticity without target, 1/2 e:C:e [Pa].
    Number
    elastic_density() const
    {
      return Number(0.5) * contract(elastic_stress, e);
    }

    /// Norm of the elastic stress, |C:e| [Pa].
    Number
    elastic_scale() const
    {
      return norm(elastic_stress);
    }

    /// Norm of the stress of a target strain, |C:D| [Pa].
    [[gnu::always_inline]] Number
    scale_of(const Matrix3<Number> &D) const
    {
      return norm(stress(material, D));
    }

    /// Energy density 1/2 (e - e*) : C : (e - e*) of stiffness damping, without its factor s.
    Number
    damping_density(const Matrix3<Number> &past) const
    {
      return energy(past);
    }

    /// Include stiffness damping with the factor s and the strain e*; returns the target of
    /// elasticity and damping together. The guard of the stretch keeps the undamped elasticity.
    Matrix3<Number>
    damp(const Matrix3<Number> &D, const Number &s, const Matrix3<Number> &past)
    {
      material = material.scaled(Number(1.) + s);
      return damped_target(D, s, past);
    }

    /// Necessary condition for the guard of the stretch to act in some lane, by the energy density
    /// of the elasticity [Pa].
    bool
    may_be_stretched(const Number & /*elastic_density*/) const
    {
      return false;
    }

    /// Whether the guard of the stretch acts in some lane.
    bool
    is_stretched() const
    {
      return false;
    }

    /// The guard of the stretch, Eq. (24), whose energy and force are not part of energy() and the
    /// law's force().
    StretchGuard<Number>
    stretch() const
    {
      return {};
    }

    /// The strain e.
    const Matrix3<Number> &
    strain() const
    {
      return e;
    }

    /// C with damping, without the volume part where that is a patch's.
    const Constants &
    own_material() const
    {
      return material;
    }

    /// The stress C:(e - D) [Pa].
    Matrix3<Number>
    stress_towards(const Matrix3<Number> &D) const
    {
      return stress(material, combine(Number(1.), e, Number(-1.), D));
    }

    /// psi, computed from e - D, because near an example the expanded square would suffer from
    /// cancellation.
    [[gnu::always_inline]] Number
    energy(const Matrix3<Number> &D) const
    {
      const Matrix3<Number> deviation = combine(Number(1.), e, Number(-1.), D);
      return Number(0.5) * contract(stress(material, deviation), deviation);
    }

    /// The stress -d psi / dD. The derivative of psi by a weight w_i is -eta times its contraction
    /// with E_i.
    Matrix3<Number>
    weight_stress(const Matrix3<Number> &D) const
    {
      return stress_towards(D);
    }

    /// Prepare the forces and responses for the target strain D.
    void
    set_target(const Matrix3<Number> &D)
    {
      T = stress_towards(D);
    }

  protected:
    QuadraticCell(const Constants &material, const Matrix3<Number> &strain)
        : material(material), e(strain), elastic_stress(stress(material, strain)), T(strain)
    {
    }

    Constants       material; ///< constants, with damping
    Matrix3<Number> e;
    Matrix3<Number> elastic_stress; ///< C:e, without damping
    Matrix3<Number> T;              ///< C:(e - D), once the target is set
  };
} // namespace Exemplar

#endif
