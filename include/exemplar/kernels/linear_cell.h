// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_linear_cell_h
#define exemplar_linear_cell_h

#include <exemplar/kernels/quadratic_cell.h>

// The linear model: the strain e = sym(F) - I, as if no cell ever turned. It shows what
// corotation is for. Its tangent is the frozen one with R = I. No deal.II header here: see
// matrix3.h.

namespace Exemplar
{
  /// A deformed cell; see CorotationalCell, of which the rotation is I.
  template <typename Number>
  class LinearCell : public QuadraticCell<Number>
  {
  public:
    static constexpr ModelTraits traits
        = { /* has_rotations */ false,    /* has_guard */ false,
            /* exact_is_rotated */ true,
            /* convex_is_rotated */ true, /* has_patches */ true,
            /* turns_freely */ false };

    /// e = sym(F) - I.
    static Matrix3<Number>
    strain_of(const Matrix3<Number> & /*rotation*/, const Matrix3<Number> &deformation_gradient)
    {
      return corotated_strain(identity_matrix<Number>(), deformation_gradient);
    }

    LinearCell(const CellMaterial<Number> &material,
               const Matrix3<Number>      &rotation,
               const Matrix3<Number>      &deformation_gradient,
               double /*p_0*/)
        : QuadraticCell<Number>(material, strain_of(rotation, deformation_gradient))
    {
    }

    Number
    force_factor() const
    {
      return Number(1.);
    }

    const Matrix3<Number> &
    elastic_force(const Matrix3<Number> &elastic_stress) const
    {
      return elastic_stress;
    }

    const Matrix3<Number> &
    force() const
    {
      return this->T;
    }
  };
} // namespace Exemplar

#endif
