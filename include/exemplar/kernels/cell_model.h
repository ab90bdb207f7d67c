// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_model_h
#define exemplar_cell_model_h

#include <exemplar/kernels/corotational_cell.h>
#include <exemplar/kernels/green_cell.h>
#include <exemplar/kernels/linear_cell.h>
#include <exemplar/kernels/polar_decomposition.h>

#include <tuple>
#include <vector>

// The laws of a cell: what its energy, forces and tangents are as functions of F, R and its constants.
// All have the members of CorotationalCell, so that a further law is a header like corotational_cell.h
// and its entries here. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// In the order of CellLaws.
  enum class CellLaw
  {
    corotational,
    frozen,
    linear,
    green
  };

  template <typename Number>
  using CellLaws = std::
      tuple<CorotationalCell<Number>, FrozenCell<Number>, LinearCell<Number>, GreenCell<Number>>;

  template <typename Cell>
  struct CellModel
  {
    using type = Cell;
  };

  /// Call `function` with the CellModel of a law.
  template <typename Number, std::size_t i = 0, typename Function>
  auto
  with_cell_model(const CellLaw law, const Function &function)
  {
    if constexpr (i + 1 < std::tuple_size_v<CellLaws<Number>>)
      if (law != static_cast<CellLaw>(i))
        return with_cell_model<Number, i + 1>(law, function);
    return function(CellModel<std::tuple_element_t<i, CellLaws<Number>>>());
  }

  inline ModelTraits
  traits_of(const CellLaw law)
  {
    return with_cell_model<double>(law, [](auto model) { return decltype(model)::type::traits; });
  }

  /// All laws, in the order of CellLaws.
  inline std::vector<CellLaw>
  all_laws()
  {
    std::vector<CellLaw> laws;
    for (std::size_t i = 0; i < std::tuple_size_v<CellLaws<double>>; ++i)
      laws.push_back(static_cast<CellLaw>(i));
    return laws;
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
