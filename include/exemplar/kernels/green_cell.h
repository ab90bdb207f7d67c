// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_green_cell_h
#define exemplar_green_cell_h

#include <exemplar/kernels/quadratic_cell.h>

// Green's strain e = 1/2 (F^T F - I) with the energy density 1/2 (e - D) : C : (e - D), the
// material of example-based elasticity in Martin et al. 2011 and, with incompatible example strains
// as here, Schumacher et al. 2012. A cell and its mirror image have the same energy. No deal.II
// header here: see matrix3.h.

namespace Exemplar
{
  /// Green's strain 1/2 (F^T F - I).
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

  /// A deformed cell with the members of CorotationalCell; its rotation is I.
  template <typename Number>
  class GreenCell : public QuadraticCell<Number>
  {
  public:
    static constexpr ModelTraits traits
        = { "green",
            "(F^T F - I)/2, that of nonlinear example-based materials",
            /* has_rotations */ false,
            /* has_guard */ false,
            /* has_stretch_guard */ false,
            /* exact_is_rotated */ false,
            /* convex_is_rotated */ false,
            /* trace_gradient_is_R */ false,
            /* is_frame_indifferent */ true };

    static Matrix3<Number>
    strain_of(const Matrix3<Number> & /*rotation*/, const Matrix3<Number> &deformation_gradient)
    {
      return green_strain(deformation_gradient);
    }

    static Matrix3<Number>
    strain_change(const Matrix3<Number> & /*rotation*/,
                  const Matrix3<Number> &deformation_gradient,
                  const Matrix3<Number> &dF)
    {
      return symmetric_part(transpose_times(deformation_gradient, dF));
    }

    template <typename Real = double>
    GreenCell(const CellMaterial<Number> &material,
              const Matrix3<Number> & /*rotation*/,
              const Matrix3<Number> &deformation_gradient,
              const ExampleNumbers<Real> & /*examples*/)
        : QuadraticCell<Number>(material, green_strain(deformation_gradient)),
          F(deformation_gradient)
    {
    }

    /// Upper bound |F| / sqrt(3) of |F T| / |T|, scaled to 1 at rest.
    Number
    force_factor() const
    {
      return sqrt(contract(F, F) / Number(3.));
    }

    Matrix3<Number>
    elastic_force() const
    {
      return F * this->elastic_stress;
    }

    /// P = F T with the second Piola-Kirchhoff stress T = C:(e - D), Eq. (19).
    Matrix3<Number>
    force() const
    {
      return F * this->T;
    }

    /// dP = dF T + F C:sym(F^T dF), Eq. (19).
    Matrix3<Number>
    response(const Matrix3<Number> &dF) const
    {
      return combine(Number(1.), dF * this->T, Number(1.),
                     F * stress(this->material, symmetric_part(transpose_times(F, dF))));
    }

    /// Let response() use the positive part of T only: it becomes positive semidefinite, and
    /// together with the columns example_response() the Hessian of a convex function of F and the
    /// weights.
    void
    make_convex()
    {
      this->T = spectral_function(this->T, [](const Number &eigenvalue)
                                  { return max(eigenvalue, Number(0.)); });
    }

    Matrix3<Number>
    example_response(const Matrix3<Number> &E) const
    {
      return F * stress(this->material, E);
    }

  private:
    Matrix3<Number> F;
  };
} // namespace Exemplar

#endif
