// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_green_h
#define exemplar_green_h

#include <exemplar/corotational.h>

// Green's strain e = 1/2 (F^T F - I) with the energy density 1/2 (e - D) : C : (e - D), the
// material of example-based elasticity in Martin et al. 2011 and, with incompatible
// example strains as here, Schumacher et al. 2012. It cannot tell a cell from its mirror
// image. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// 1/2 (F^T F - I).
  template <typename Number>
  Matrix3<Number>
  green_strain(const Matrix3<Number> &deformation_gradient)
  {
    Matrix3<Number> strain = transpose_times(deformation_gradient, deformation_gradient);
    for (int i = 0; i < 3; ++i)
    {
      strain[i][i] -= Number(1.);
      for (int j = 0; j < 3; ++j)
        strain[i][j] *= Number(0.5);
    }
    return strain;
  }

  /// A deformed cell; see CorotationalCell, of which the rotation is I.
  template <typename Number>
  class GreenCell
  {
  public:
    GreenCell(const Lame<Number> &lame,
              const Matrix3<Number> & /*rotation*/,
              const Matrix3<Number> &deformation_gradient,
              const Number & /*p_0*/)
        : lame(lame), F(deformation_gradient), e(green_strain(F)), T(e)
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

    /// |F T| <= |F| |T|, of which |F|^2 = 3 at rest.
    Number
    force_factor() const
    {
      return std::sqrt(contract(F, F) / Number(3.));
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
      return F * stress(lame, e);
    }

    void
    set_target(const Matrix3<Number> &D)
    {
      T = weight_stress(D);
    }

    /// P = F T with the second Piola-Kirchhoff stress T = C:(e - D).
    Matrix3<Number>
    force() const
    {
      return F * T;
    }

    /// dP = dF T + F C:sym(F^T dF).
    Matrix3<Number>
    response(const Matrix3<Number> &dF) const
    {
      return combine(Number(1.), dF * T, Number(1.),
                     F * stress(lame, symmetric_part(transpose_times(F, dF))));
    }

    /// From now on response() keeps the positive part of T only: it is never negative, and
    /// together with the columns example_response() the Hessian of a convex function of F
    /// and the weights.
    void
    make_convex()
    {
      T = spectral_function(T, [](const Number &eigenvalue)
                            { return eigenvalue > Number(0.) ? eigenvalue : Number(0.); });
    }

    Matrix3<Number>
    example_response(const Matrix3<Number> &E) const
    {
      return F * stress(lame, E);
    }

  private:
    Lame<Number>    lame;
    Matrix3<Number> F;
    Matrix3<Number> e;
    Matrix3<Number> T;
  };
} // namespace Exemplar

#endif
