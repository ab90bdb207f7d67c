// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_model_h
#define exemplar_cell_model_h

#include <exemplar/kernels/corotational_cell.h>
#include <exemplar/kernels/green_cell.h>
#include <exemplar/kernels/linear_cell.h>
#include <exemplar/kernels/polar_decomposition.h>

// The laws of a cell. CorotationalCell, FrozenCell, LinearCell and GreenCell have the same members,
// so that a further law is a header like theirs, a value of CellLaw and a case of with_cell_model().
// No deal.II header here: see matrix3.h.

namespace Exemplar
{
  enum class CellLaw
  {
    corotational,
    frozen,
    linear,
    green
  };

  template <typename Cell>
  struct CellModel
  {
    using type = Cell;
  };

  /// Call `function` with the CellModel of a law.
  template <typename Number, typename Function>
  auto
  with_cell_model(const CellLaw law, const Function &function)
  {
    switch (law)
    {
    case CellLaw::frozen:
      return function(CellModel<FrozenCell<Number>>());
    case CellLaw::linear:
      return function(CellModel<LinearCell<Number>>());
    case CellLaw::green:
      return function(CellModel<GreenCell<Number>>());
    default:
      return function(CellModel<CorotationalCell<Number>>());
    }
  }

  inline ModelTraits
  traits_of(const CellLaw law)
  {
    return with_cell_model<double>(law, [](auto model) { return decltype(model)::type::traits; });
  }

  /// The rotation of a cell that a model sees: I where it has none.
  inline Matrix3<double>
  model_rotation(const CellLaw law, const Matrix3<double> &deformation_gradient)
  {
    return traits_of(law).has_rotations ? closest_rotation(deformation_gradient)
                                        : identity_matrix<double>();
  }

  /// The strain of a cell, Eq. (2) or its counterpart.
  inline Matrix3<double>
  model_strain(const CellLaw          law,
               const Matrix3<double> &rotation,
               const Matrix3<double> &deformation_gradient)
  {
    return with_cell_model<double>(
        law, [&](auto model)
        { return decltype(model)::type::strain_of(rotation, deformation_gradient); });
  }

  /// Call `function` with a cell of a law, where the guard of Eq. (16) has the bound p_0.
  template <typename Function>
  auto
  with_cell(const CellLaw               law,
            const CellMaterial<double> &material,
            const Matrix3<double>      &rotation,
            const Matrix3<double>      &deformation_gradient,
            const double                p_0,
            const Function             &function)
  {
    return with_cell_model<double>(law,
                                   [&](auto model)
                                   {
                                     using Cell = typename decltype(model)::type;
                                     return function(
                                         Cell(material, rotation, deformation_gradient, p_0));
                                   });
  }

  /// Whether the guard of Eq. (16) with the bound p_0 acts in a cell.
  inline bool
  model_is_guarded(const CellLaw               law,
                   const CellMaterial<double> &material,
                   const Matrix3<double>      &rotation,
                   const Matrix3<double>      &deformation_gradient,
                   const double                p_0)
  {
    return with_cell(law, material, rotation, deformation_gradient, p_0,
                     [](const auto &cell) { return cell.is_guarded(); });
  }

  /// G of Eq. (24) in a cell that is stretched so far, else 0 [Pa].
  inline double
  model_stretch_energy(const CellLaw               law,
                       const CellMaterial<double> &material,
                       const Matrix3<double>      &rotation,
                       const Matrix3<double>      &deformation_gradient,
                       const double                p_0)
  {
    return with_cell(law, material, rotation, deformation_gradient, p_0,
                     [](const auto &cell)
                     { return cell.is_stretched() ? cell.stretch().energy() : 0.; });
  }
} // namespace Exemplar

#endif
