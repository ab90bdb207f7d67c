// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_laws_with_derivatives_h
#define exemplar_laws_with_derivatives_h

#include <exemplar/kernels/cell_model.h>
#include <exemplar/kernels/hyper_dual.h>
#include <exemplar/run/adjoint/point_material.h>

#include <algorithm>

// Laws are those of kernels/cell_model.h: what is written there for registers is taken here for numbers that carry
// derivatives.

namespace Exemplar
{
  /// Whether forces are the derivative of an energy that knows nothing of earlier steps.
  template <typename Cell>
  constexpr bool has_potential = Cell::traits.n_history == 0
                                 && !(Cell::traits.exact_is_rotated
                                      && Cell::traits.has_rotations); // frozen forces have none

  inline bool
  law_has_potential(const CellLaw law)
  {
    return with_cell_model<double>(law, [](auto model)
                                   { return has_potential<typename decltype(model)::type>; });
  }

  /// The rotation of F, where that of its value is R. A Newton step makes first derivatives right; from there
  /// one makes it orthogonal, and one more right, to second derivatives.
  template <typename Number>
  Matrix3<Number>
  rotation_near(const Matrix3<double> &R, const Matrix3<Number> &F)
  {
    Matrix3<Number> result = constant_matrix<Number>(R);
    for (int step = 0; step < 3; ++step)
      result = Polar::polished(result, F);
    return result;
  }

  /// The number with its first m derivatives, of which others are 0.
  template <std::size_t m, std::size_t n>
  Matrix3<HyperDual<m>>
  resized(const Matrix3<HyperDual<n>> &A)
  {
    Matrix3<HyperDual<m>> result;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
      {
        const HyperDual<n> &from = A[i][j];
        HyperDual<m>       &to   = result[i][j];
        to                       = HyperDual<m>(from.value, from.change);
        std::copy_n(from.by.begin(), std::min(m, n), to.by.begin());
        std::copy_n(from.change_by.begin(), std::min(m, n), to.change_by.begin());
      }
    return result;
  }

  /// The same where the first nine derivatives are those by F, and F has no others.
  template <std::size_t n>
  Matrix3<HyperDual<n>>
  rotation_by_F(const Matrix3<double> &R, const Matrix3<HyperDual<n>> &F)
  {
    if constexpr (n > 9)
      return resized<n>(rotation_near(R, resized<9>(F)));
    else
      return rotation_near(R, F);
  }

  /// Call function(model) with the CellModel of a law that has_potential().
  template <typename Number, typename Function>
  void
  with_potential(const CellLaw law, const Function &function)
  {
    with_cell_model<Number>(law,
                            [&function](auto model)
                            {
                              if constexpr (has_potential<typename decltype(model)::type>)
                                function(model);
                            });
  }

  /// The strain of a law, of which R is the rotation of the value of F.
  template <typename Cell, typename Number>
  Matrix3<Number>
  strain_near(const Matrix3<double> &R, const Matrix3<Number> &F)
  {
    if constexpr (Cell::traits.has_rotations)
      return Cell::strain_of(rotation_near(R, F), F);
    else
      return Cell::strain_of(identity_matrix<Number>(), F);
  }
} // namespace Exemplar

#endif
