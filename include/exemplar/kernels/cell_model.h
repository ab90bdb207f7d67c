// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_model_h
#define exemplar_cell_model_h

#include <exemplar/kernels/corotational_cell.h>
#include <exemplar/kernels/fibrous_plastic_cell.h>
#include <exemplar/kernels/grain_cell.h>
#include <exemplar/kernels/green_cell.h>
#include <exemplar/kernels/linear_cell.h>
#include <exemplar/kernels/neo_hookean_cell.h>
#include <exemplar/kernels/plastic_cell.h>
#include <exemplar/kernels/polar_decomposition.h>
#include <exemplar/kernels/viscoelastic_cell.h>

#include <algorithm>
#include <tuple>
#include <vector>

// The constitutive laws of a cell: energy, forces and tangents as functions of F, R and constants.
// All have the members of CorotationalCell, so that a further law is a header like
// corotational_cell.h and its entries here, with its history variables and the constants that it
// adds to the keys of Material. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// The constitutive laws, in the order of CellLaws.
  enum class CellLaw
  {
    corotational,
    frozen,
    linear,
    green,
    fibrous,
    anisotropic,
    plastic,
    neo_hookean,
    viscoelastic,
    fibrous_plastic
  };

  template <typename Number>
  using CellLaws = std::tuple<CorotationalCell<Number>,
                              FrozenCell<Number>,
                              LinearCell<Number>,
                              GreenCell<Number>,
                              FibrousCell<Number>,
                              AnisotropicCell<Number>,
                              PlasticCell<Number>,
                              NeoHookeanCell<Number>,
                              ViscoelasticCell<Number>,
                              FibrousPlasticCell<Number>>;

  /// Type tag of a law; without data.
  template <typename Cell>
  struct CellModel
  {
    using type = Cell;
  };

  /// Call `function` with the CellModel of a law, which is number i or a later one.
  template <typename Number, std::size_t i = 0, typename Function>
  auto
  with_cell_model(const CellLaw law, const Function &function)
  {
    if constexpr (i + 1 < std::tuple_size_v<CellLaws<Number>>)
      if (law != static_cast<CellLaw>(i))
        return with_cell_model<Number, i + 1>(law, function);
    return function(CellModel<std::tuple_element_t<i, CellLaws<Number>>>());
  }

  /// Whether forces are the derivative of an energy that does not depend on earlier steps.
  template <typename Cell>
  constexpr bool has_potential = Cell::traits.n_history == 0
                                 && !(Cell::traits.exact_is_rotated
                                      && Cell::traits.has_rotations); // frozen forces have none

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

  template <typename... Cell>
  constexpr std::size_t
  greatest_history(const std::tuple<Cell...> * /*laws*/)
  {
    return std::max({ Cell::traits.n_history... });
  }

  /// Greatest number of history variables at a point, of all laws.
  inline constexpr std::size_t max_history
      = greatest_history(static_cast<CellLaws<double> *>(nullptr));

  /// The rotation R in a law: the closest to F, or I for a law without rotations.
  inline Matrix3<double>
  model_rotation(const CellLaw law, const Matrix3<double> &deformation_gradient)
  {
    return traits_of(law).has_rotations ? closest_rotation(deformation_gradient)
                                        : identity_matrix<double>();
  }

  /// The strain e of a cell, Eq. (2) or its counterpart.
  inline Matrix3<double>
  model_strain(const CellLaw          law,
               const Matrix3<double> &rotation,
               const Matrix3<double> &deformation_gradient)
  {
    return with_cell_model<double>(
        law, [&](auto model)
        { return decltype(model)::type::strain_of(rotation, deformation_gradient); });
  }

  /// The change of the strain by a change dF of the deformation gradient.
  inline Matrix3<double>
  model_strain_change(const CellLaw          law,
                      const Matrix3<double> &rotation,
                      const Matrix3<double> &deformation_gradient,
                      const Matrix3<double> &dF)
  {
    return with_cell_model<double>(
        law, [&](auto model)
        { return decltype(model)::type::strain_change(rotation, deformation_gradient, dF); });
  }

  /// The stress C:E [Pa] by the constants of a law, where number(k) returns constant k.
  template <typename Load>
  Matrix3<double>
  model_stress(const CellLaw law, const Load &number, const Matrix3<double> &E)
  {
    return with_cell_model<double>(
        law, [&](auto model)
        { return stress(decltype(model)::type::Constants::from_numbers(number), E); });
  }

  /// Number of a law's Constants at a point.
  inline std::size_t
  n_constants(const CellLaw law)
  {
    return with_cell_model<double>(law, [](auto model)
                                   { return decltype(model)::type::Constants::n_numbers; });
  }

  /// The combinations that a law refuses.
  inline std::vector<Refusal>
  refusals_of(const CellLaw law)
  {
    return with_cell_model<double>(law,
                                   [](auto model)
                                   {
                                     const auto &refusals = decltype(model)::type::refusals;
                                     return std::vector<Refusal>(refusals.begin(), refusals.end());
                                   });
  }

  /// The constants of a law beside those of elasticity.h, in their order.
  inline std::vector<LawConstant>
  own_constants(const CellLaw law)
  {
    return with_cell_model<double>(law,
                                   [](auto model)
                                   {
                                     const auto &own
                                         = decltype(model)::type::Constants::own_constants;
                                     return std::vector<LawConstant>(own.begin(), own.end());
                                   });
  }
} // namespace Exemplar

#endif
