// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_quadratic_cell_h
#define exemplar_quadratic_cell_h

#include <exemplar/kernels/elasticity.h>
#include <exemplar/kernels/model_traits.h>
#include <exemplar/kernels/stretch_guard.h>
#include <exemplar/kernels/tetrahedron.h>

// What the models without rotations share. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// A deformed cell of energy density 1/2 (e - D) : C : (e - D) with a strain e that is a
  /// function of F alone; the members are those of CorotationalCell.
  template <typename Number>
  class QuadraticCell
  {
  public:
    using Constants = CellMaterial<Number>;

    auto
    is_guarded() const
    {
      return Number(0.) > Number(1.); // false in every lane
    }

    /// As CorotationalCell.
    Number
    elastic_density() const
    {
      return Number(0.5) * contract(elastic_stress, e);
    }

    Number
    elastic_scale() const
    {
      return norm(elastic_stress);
    }

    Number
    scale_of(const Matrix3<Number> &D) const
    {
      return norm(stress(material, D));
    }

    Matrix3<Number>
    damp(const Matrix3<Number> &D, const Number &s, const Matrix3<Number> &past)
    {
      material = material.scaled(Number(1.) + s);
      return damped_target(D, s, past);
    }

    bool
    may_be_stretched(const Number &) const
    {
      return false;
    }

    bool
    is_stretched() const
    {
      return false;
    }

    StretchGuard<Number>
    stretch() const
    {
      return {};
    }

    const Matrix3<Number> &
    strain() const
    {
      return e;
    }

    Number
    energy(const Matrix3<Number> &D) const
    {
      const Matrix3<Number> deviation = combine(Number(1.), e, Number(-1.), D);
      return Number(0.5) * contract(stress(material, deviation), deviation);
    }

    Matrix3<Number>
    weight_stress(const Matrix3<Number> &D) const
    {
      return stress(material, combine(Number(1.), e, Number(-1.), D));
    }

    void
    set_target(const Matrix3<Number> &D)
    {
      T = weight_stress(D);
    }

  protected:
    QuadraticCell(const CellMaterial<Number> &material, const Matrix3<Number> &strain)
        : material(material), e(strain), elastic_stress(stress(material, strain)), T(strain)
    {
    }

    CellMaterial<Number> material;
    Matrix3<Number>      e;
    Matrix3<Number>      elastic_stress; ///< C:e, without damping
    Matrix3<Number>      T; ///< C:(e - D), once the target is set
  };
} // namespace Exemplar

#endif
