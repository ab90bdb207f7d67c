// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_point_elasticity_h
#define exemplar_point_elasticity_h

#include <exemplar/body/material.h>
#include <exemplar/body/strain_parts.h>
#include <exemplar/kernels/dual.h>

#include <optional>

namespace Exemplar
{
  /// The constants by which points have derivatives, with their places behind that along the
  /// direction.
  namespace OfPoint
  {
    constexpr std::size_t E = 1, nu = 2, eta = 3, guard_bound = 4, n_constants = 4;

    /// Number with a change along the direction alone.
    using Changing = Dual<1>;

    /// Number with derivatives by E, nu and eta, too.
    using Regular = Dual<4>;

    /// Number with the derivative by p_0 of Eq. (16), too, where its guard acts.
    using Guarded = Dual<5>;

    /// The constant whose derivative k is 1, if the number has it.
    template <typename Number>
    Number
    seeded(const double value, const std::size_t k)
    {
      Number number(value);
      if (k < Number::n_derivatives)
        number.by[k] = 1.;
      return number;
    }
  } // namespace OfPoint

  /// What the material of a body is, and what its examples act on.
  struct BodyMaterial
  {
    const Material &material, &cell_material; ///< with the part that patches take, and without
    ActsOn          acts_on;
    bool            has_patches;
  };

  /// The elasticity of a cell as a function of Young's modulus, Poisson's ratio and eta.
  template <typename Number>
  class PointElasticity
  {
  public:
    /// `eta` is that of all cells.
    PointElasticity(const BodyMaterial &of, const unsigned int cell, const Number &eta)
        : PointElasticity(
            of,
            cell,
            eta,
            OfPoint::seeded<Number>(of.material.of_body_alone(cell).youngs_modulus, OfPoint::E),
            OfPoint::seeded<Number>(of.material.of_body_alone(cell).poissons_ratio, OfPoint::nu))
    {
    }

    /// eta of the cell.
    const Number &
    importance() const
    {
      return eta;
    }

    /// The part of C that patches take [Pa].
    Number
    lambda_of_patches() const
    {
      return whole().lambda_of_patches();
    }

    /// Lame's constants in the guards.
    const Isotropic<Number> &
    isotropic_part() const
    {
      return whole().isotropic;
    }

    /// Constants of the cells' own energy, less the part that patches take.
    template <typename Constants>
    Constants
    of_law(const CellLaw law) const
    {
      return Constants::from_numbers(
          [&](const std::size_t k)
          {
            if (law == CellLaw::anisotropic)
              return Number(of.cell_material.number(law, cell, k));
            switch (k)
            {
            case 0:
              return of.has_patches ? whole().isotropic.lambda - lambda_of_patches()
                                    : whole().isotropic.lambda;
            case 1:
              return whole().isotropic.mu;
            case 2:
              return whole().fibre_stiffness;
            default:
              return Number(axes.along[k - 3]);
            }
          });
    }

    /// The target D, Eq. (31), from the blend sum w_i E_i of the examples' strains.
    Matrix3<Number>
    target(const Matrix3<Number> &wish) const
    {
      const Matrix3<Number> E = acting.of(wish);
      return blend ? blend->drawn_strain(E) : times(eta, E);
    }

    /// The derivative by the wish of a function with this derivative by the target.
    Matrix3<Number>
    by_wish(const Matrix3<Number> &by_target) const
    {
      return acting.by_strain(blend ? blend->by_strain(by_target) : times(eta, by_target));
    }

    /// The derivative by D of the form of the weights beyond that of the targets, without the part
    /// that patches take; `C` is the elasticity of the law.
    template <typename Constants>
    Matrix3<Number>
    excess_stress(const Constants &C, const Matrix3<Number> &D) const
    {
      if (!(eta > Number(0.)))
        return {};
      if (!blend)
        return times((Number(1.) - eta) / eta, stress(C, D));
      return combine(Number(1.), blend->excess_stress(D), -excess_of_patches() * trace(D),
                     identity_matrix<Number>());
    }

    /// Lambda of the part that patches take of the form of the weights [Pa], where examples have an
    /// elasticity of their own.
    Number
    excess_of_patches() const
    {
      return blend && of.has_patches ? blend->excess_of_patches() : Number(0.);
    }

  private:
    PointElasticity(const BodyMaterial &of,
                    const unsigned int  cell,
                    const Number       &eta,
                    const Number       &E,
                    const Number       &nu)
        : of(of), cell(cell), axes(of.material.grain_axes(cell)),
          eta(Number(of.material.importance(cell)) * eta),
          C(elasticity_of(of.material.of_body_alone(cell).whole, E, nu)),
          blend(blend_of(of.material.elasticity_of_examples(), E, nu)),
          acting(of.acts_on, blend ? blend->of_examples() : C, axes)
    {
    }

    static CellElasticity<Number>
    elasticity_of(const CellElasticity<double> &whole, const Number &E, const Number &nu)
    {
      const Number fibres(whole.fibre_stiffness);
      if (!whole.orthotropic)
        return { isotropic_of(E, nu), fibres, {} };
      // nine constants have no derivatives
      return { { Number(whole.isotropic.lambda), Number(whole.isotropic.mu) },
               fibres,
               Orthotropy<Number>(*whole.orthotropic) };
    }

    std::optional<BlendedElasticity<Number>>
    blend_of(const ExampleElasticity &own, const Number &E, const Number &nu) const
    {
      if (!own.is_own())
        return {};
      return BlendedElasticity<Number>(C, own.isotropic(E, nu), eta, axes);
    }

    /// C' of Eq. (38), or C.
    const CellElasticity<Number> &
    whole() const
    {
      return blend ? blend->of_both() : C;
    }

    const BodyMaterial                      &of;
    unsigned int                             cell;
    GrainAxes                                axes;
    Number                                   eta;
    CellElasticity<Number>                   C;
    std::optional<BlendedElasticity<Number>> blend;
    ActingStrain<Number>                     acting;
  };
} // namespace Exemplar

#endif
