// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_model_h
#define exemplar_cell_model_h

#include <exemplar/kernels/corotational_cell.h>
#include <exemplar/kernels/green_cell.h>
#include <exemplar/kernels/linear_cell.h>
#include <exemplar/kernels/polar_decomposition.h>

// The models of a cell: CorotationalCell, LinearCell and GreenCell have the same members.
// No deal.II header here: see matrix3.h.

namespace Exemplar
{
  enum class StrainMeasure
  {
    corotational,
    linear,
    green
  };

  template <typename Cell>
  struct CellModel
  {
    using type = Cell;
  };

  /// Call `function` with the CellModel of a strain measure.
  template <typename Number, typename Function>
  auto
  with_cell_model(const StrainMeasure measure, const Function &function)
  {
    switch (measure)
    {
    case StrainMeasure::linear:
      return function(CellModel<LinearCell<Number>>());
    case StrainMeasure::green:
      return function(CellModel<GreenCell<Number>>());
    default:
      return function(CellModel<CorotationalCell<Number>>());
    }
  }

  /// The rotation of a cell that a model sees: I where it has none.
  inline Matrix3<double>
  model_rotation(const StrainMeasure measure, const Matrix3<double> &deformation_gradient)
  {
    return measure == StrainMeasure::corotational ? closest_rotation(deformation_gradient)
                                                  : identity_matrix<double>();
  }

  /// The strain of a cell, Eq. (2) or its counterpart.
  inline Matrix3<double>
  model_strain(const StrainMeasure    measure,
               const Matrix3<double> &rotation,
               const Matrix3<double> &deformation_gradient)
  {
    return measure == StrainMeasure::green ? green_strain(deformation_gradient)
                                           : corotated_strain(rotation, deformation_gradient);
  }
} // namespace Exemplar

#endif
