// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_fibrous_plastic_cell_h
#define exemplar_fibrous_plastic_cell_h

#include <exemplar/kernels/grain_cell.h>
#include <exemplar/kernels/plastic_cell.h>

// Plastic cells with elastic fibres. Radial return requires isotropy, so the fibres see the whole
// strain e instead of its elastic part:
//
//   psi = psi of PlasticCell + 1/2 (e - D) : C_a : (e - D) + its guard,
//   C_a = alpha a a a a,   D = eta E(w),
//
// see grain_cell.h. Both parts are functions of the same S, and all members are linear in the
// energy, so the cell is a sum of two. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// PlasticConstants, joined by the stiffness and direction of Fibrous.
  template <typename Number>
  struct FibrousPlasticConstants : PlasticConstants<Number>
  {
    using Plastic = PlasticConstants<Number>;
    using Fibres  = Fibrous<Number>;

    static constexpr bool is_isotropic = false;

    static constexpr std::size_t n_numbers = Plastic::n_numbers + 4;

    static constexpr std::array<LawConstant, 6> own_constants
        = { { Plastic::own_constants[0], Plastic::own_constants[1], Plastic::own_constants[2],
              Plastic::own_constants[3], Plastic::own_constants[4], Fibres::own_constants[0] } };

    Number          alpha;
    Vector3<Number> a; ///< unit vector

    template <typename Load>
    static FibrousPlasticConstants
    from_numbers(const Load &load)
    {
      constexpr std::size_t n = Plastic::n_numbers;
      return { Plastic::from_numbers(load),
               load(n),
               { { load(n + 1), load(n + 2), load(n + 3) } } };
    }

    /// The material with `factor` times C; the yield stress stays.
    FibrousPlasticConstants
    scaled(const Number &factor) const
    {
      FibrousPlasticConstants C = *this;
      C.lambda *= factor;
      C.mu *= factor;
      C.alpha *= factor;
      return C;
    }

    /// The fibres without the matrix around them.
    Fibres
    fibres() const
    {
      return { Number(0.), Number(0.), alpha, a };
    }
  };

  /// C:E [Pa].
  template <typename Number>
  Matrix3<Number>
  stress(const FibrousPlasticConstants<Number> &material, const Matrix3<Number> &E)
  {
    return combine(Number(1.), stress(CellMaterial<Number>(material), E), Number(1.),
                   anisotropic_stress(material.fibres(), E));
  }

  /// A deformed cell; see CorotationalCell.
  template <typename Number>
  class FibrousPlasticCell : public PlasticCell<Number>
  {
    using Plastic = PlasticCell<Number>;

  public:
    using Constants = FibrousPlasticConstants<Number>;

    static constexpr ModelTraits traits = chosen_by(with_name(Plastic::traits, "fibrous plastic"),
                                                    Plastic::Constants::own_constants[0].name,
                                                    Constants::Fibres::own_constants[0].name);

    FibrousPlasticCell(const Constants        &constants,
                       const Matrix3<Number>  &rotation,
                       const Matrix3<Number>  &deformation_gradient,
                       const ExampleConstants &examples)
        : Plastic(constants, rotation, deformation_gradient, examples),
          fibres(constants.fibres(), rotation, deformation_gradient, examples)
    {
      // the plastic part has the guard of the stretch: without lambda the fibres have none
      fibres.set_guard_elasticity({ Number(0.), constants.mu });
    }

    Number
    elastic_density() const
    {
      return Plastic::elastic_density() + fibres.elastic_density();
    }

    Number
    elastic_scale() const
    {
      return Plastic::elastic_scale() + fibres.elastic_scale();
    }

    Number
    scale_of(const Matrix3<Number> &D) const
    {
      return Plastic::scale_of(D) + fibres.scale_of(D);
    }

    Number
    damping_density(const Matrix3<Number> &past) const
    {
      return Plastic::damping_density(past) + fibres.damping_density(past);
    }

    Matrix3<Number>
    damp(const Matrix3<Number> &D, const Number &s, const Matrix3<Number> &past)
    {
      fibres.damp(D, s, past);
      return Plastic::damp(D, s, past);
    }

    Matrix3<Number>
    stress_towards(const Matrix3<Number> &D) const
    {
      return sum(Plastic::stress_towards(D), fibres.stress_towards(D));
    }

    Number
    energy(const Matrix3<Number> &D) const
    {
      return Plastic::energy(D) + fibres.energy(D);
    }

    Number
    energy() const
    {
      return Plastic::energy() + fibres.elastic_density();
    }

    Matrix3<Number>
    weight_stress(const Matrix3<Number> &D) const
    {
      return sum(Plastic::weight_stress(D), fibres.weight_stress(D));
    }

    Matrix3<Number>
    elastic_force()
    {
      return sum(Plastic::elastic_force(), fibres.elastic_force());
    }

    void
    set_target(const Matrix3<Number> &D)
    {
      Plastic::set_target(D);
      fibres.set_target(D);
    }

    Matrix3<Number>
    force() const
    {
      return sum(Plastic::force(), fibres.force());
    }

    Matrix3<Number>
    response(const Matrix3<Number> &M) const
    {
      return sum(Plastic::response(M), this->has_convex_tangent()
                                           ? fixed_response(symmetric_part(M))
                                           : fibres.response(M));
    }

    Matrix3<Number>
    example_response(const Matrix3<Number> &E) const
    {
      return sum(Plastic::example_response(E),
                 this->has_convex_tangent() ? fixed_response(E) : fibres.example_response(E));
    }

  private:
    static Matrix3<Number>
    sum(const Matrix3<Number> &A, const Matrix3<Number> &B)
    {
      return combine(Number(1.), A, Number(1.), B);
    }

    /// Response of the fibres with a fixed rotation, with damping.
    Matrix3<Number>
    fixed_response(const Matrix3<Number> &E) const
    {
      return stress(fibres.own_material(), E);
    }

    CorotationalCell<Number, Fibrous<Number>> fibres;
  };
} // namespace Exemplar

#endif
