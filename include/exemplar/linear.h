// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_linear_h
#define exemplar_linear_h

#include <exemplar/corotational.h>

// The linear model: the strain e = sym(F) - I, as if no cell ever turned. It shows what
// corotation is for. Its tangent is the frozen one with R = I. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// A deformed cell; see CorotationalCell, of which the rotation is I.
  template <typename Number>
  class LinearCell
  {
  public:
    LinearCell(const Lame<Number> &lame,
               const Matrix3<Number> & /*rotation*/,
               const Matrix3<Number> &deformation_gradient,
               const Number & /*p_0*/)
        : lame(lame), e(corotated_strain(identity_matrix<Number>(), deformation_gradient)), T(e)
    {
    }

    bool
    is_guarded() const
    {
      return false;
    }

    const Matrix3<Number> &
    strain() const
    {
      return e;
    }

    Number
    force_factor() const
    {
      return Number(1.);
    }

    Number
    energy(const Matrix3<Number> &D) const
    {
      const Matrix3<Number> deviation = combine(Number(1.), e, Number(-1.), D);
      return Number(0.5) * contract(stress(lame, deviation), deviation);
    }

    Matrix3<Number>
    weight_stress(const Matrix3<Number> &D) const
    {
      return stress(lame, combine(Number(1.), e, Number(-1.), D));
    }

    Matrix3<Number>
    elastic_force() const
    {
      return stress(lame, e);
    }

    void
    set_target(const Matrix3<Number> &D)
    {
      T = weight_stress(D);
    }

    const Matrix3<Number> &
    force() const
    {
      return T;
    }

  private:
    Lame<Number>    lame;
    Matrix3<Number> e;
    Matrix3<Number> T;
  };
} // namespace Exemplar

#endif
