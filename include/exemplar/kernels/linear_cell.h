// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_linear_cell_h
#define exemplar_linear_cell_h

#include <exemplar/kernels/quadratic_cell.h>

// Laws that hold the rotation R fixed under differentiation, so that they are linear in F, with the
// strain e = sym(R^T F) - I and the tangent R K R^T. FrozenCell has the paper's force R T, Eq. (6),
// which is no gradient with examples. LinearCell has R = I, linear elasticity; it serves as a
// comparison with corotation. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// A deformed cell; see CorotationalCell.
  template <typename Number, bool turns>
  class FixedRotationCell : public QuadraticCell<Number>
  {
  public:
    static constexpr ModelTraits traits
        = { turns ? "frozen" : "linear",
            turns ? "" : "sym(F) - I, for comparison, wrong where cells turn",
            /* has_rotations */ turns,
            /* has_guard */ false,
            /* has_stretch_guard */ false,
            /* exact_is_rotated */ true,
            /* convex_is_rotated */ true,
            /* trace_gradient_is_R */ true,
            /* is_frame_indifferent */ turns };

    /// e = sym(R^T F) - I.
    static Matrix3<Number>
    strain_of(const Matrix3<Number> &rotation, const Matrix3<Number> &deformation_gradient)
    {
      return corotated_strain(rotation, deformation_gradient);
    }

    template <typename Real = double>
    FixedRotationCell(const CellMaterial<Number> &material,
                      const Matrix3<Number>      &rotation,
                      const Matrix3<Number>      &deformation_gradient,
                      const ExampleNumbers<Real> & /*examples*/)
        : QuadraticCell<Number>(material, strain_of(rotation, deformation_gradient))
    {
    }

    Number
    force_factor() const
    {
      return Number(1.);
    }

    const Matrix3<Number> &
    elastic_force() const
    {
      return this->elastic_stress;
    }

    const Matrix3<Number> &
    force() const
    {
      return this->T;
    }
  };

  template <typename Number>
  using FrozenCell = FixedRotationCell<Number, true>;

  template <typename Number>
  using LinearCell = FixedRotationCell<Number, false>;
} // namespace Exemplar

#endif
