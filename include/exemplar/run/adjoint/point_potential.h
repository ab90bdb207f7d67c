// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_point_potential_h
#define exemplar_point_potential_h

#include <exemplar/kernels/cell_model.h>
#include <exemplar/kernels/hyper_dual.h>
#include <exemplar/kernels/patch_cell.h>
#include <exemplar/run/adjoint/patch_potential.h>
#include <exemplar/run/adjoint/point_material.h>

#include <algorithm>

// The potential of a point as one function of all that it depends on, for numbers that carry derivatives. Laws
// are those of kernels/cell_model.h: what is written there for registers is taken here for such numbers.

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

  /// What is the same at all points.
  struct PointScene
  {
    ExampleConstants examples;
    double           blended_part; ///< of the blended energy
    bool             has_patches;
  };

  /// Where the potential of a point is taken.
  template <typename Number>
  struct PointPlace
  {
    Matrix3<double>           R; ///< the rotation of the value of F
    Matrix3<Number>           F;
    Matrix3<Number>           wish; ///< sum w_i E_i of the examples' strains
    MaterialFunctions<Number> material;
    Number                    importance; ///< eta of all cells
  };

  /// Over the volume.
  template <typename Number>
  struct PointPotential
  {
    Number            own;
    PatchSums<Number> of_patch;       ///< what its patch sums up, but for the bound of the guard
    Number            by_guard_bound; ///< derivative by p_0 of Eq. (16)
  };

  /// The potential of a point with the law of a cell.
  template <typename Cell, typename Number>
  class PointEvaluation
  {
  public:
    PointEvaluation(const CellLaw law, const PointScene &scene, const PointPlace<Number> &at)
        : scene(scene), at(at), D(at.material.target(at.wish)),
          cell(at.material.template of_law<typename Cell::Constants>(law, scene.has_patches),
               rotation(),
               at.F,
               scene.examples)
    {
    }

    PointPotential<Number>
    find()
    {
      PointPotential<Number> found{ cell.energy(D), {}, Number(0.) };
      add_share(found.own);
      add_guard(found);
      add_form_of_weights(found);
      if (scene.has_patches)
        add_patch(found.of_patch);
      return found;
    }

  private:
    Matrix3<Number>
    rotation() const
    {
      if constexpr (Cell::traits.has_rotations)
        return rotation_by_F(at.R, at.F);
      return identity_matrix<Number>();
    }

    /// A law that knows eta has it as a number without derivatives.
    void
    add_share(Number &own) const
    {
      if constexpr (Cell::traits.knows_volume)
      {
        const Number change = at.importance - Number(scene.examples.importance);
        const Number of_strain
            = Number(0.5) * contract(stress(cell.own_material(), cell.strain()), cell.strain());
        own += change * (of_strain - cell.elastic_density());
        if (!scene.has_patches && cell.is_stretched()) // whose energy is proportional to eta
          own += change / at.importance * cell.stretch().energy();
      }
    }

    void
    add_guard(PointPotential<Number> &found) const
    {
      if constexpr (Cell::traits.has_guard)
      {
        if (!scene.has_patches && cell.is_stretched())
          found.own += cell.stretch().energy();
        if (!cell.is_guarded())
          return;
        const Number p_0 = Number(scene.examples.guard_bound), p = cell.product_of_sums();
        found.by_guard_bound
            = guard_energy(cell.own_material(), Number(1.), cell.stretch_factor(), D)
              * guard(p, p_0).derivative * p / p_0;
      }
    }

    /// What the weights' form has beyond the Gram matrix of the targets.
    void
    add_form_of_weights(PointPotential<Number> &found) const
    {
      const Number &eta  = at.material.importance();
      const Number  half = Number(0.5 * scene.blended_part);
      if (at.material.has_own_examples())
      {
        const auto excess = at.material.excess(D, scene.has_patches);
        found.own += half * excess.energy;
        found.of_patch[PatchSum::excess] = excess.lambda_of_patches;
      }
      else if (eta > Number(0.))
        found.own += half * (Number(1.) - eta) / eta * contract(stress(cell.own_material(), D), D);
    }

    void
    add_patch(PatchSums<Number> &to) const
    {
      if constexpr (Cell::traits.trace_gradient_is_R)
      {
        to[PatchSum::volume]     = Number(1.);
        to[PatchSum::lambda]     = at.material.lambda_of_patches();
        to[PatchSum::trace]      = trace(cell.strain());
        to[PatchSum::wish]       = trace(D);
        to[PatchSum::square]     = contract(at.F, at.F);
        to[PatchSum::importance] = at.material.importance();
        if constexpr (Cell::traits.has_guard_of_patches())
          add_guards_of_patch(to);
        if constexpr (Cell::traits.knows_volume)
          to[PatchSum::volume_change] = volume_change(cell.strain());
        to[PatchSum::trace_square] = to[PatchSum::trace] * to[PatchSum::trace];
      }
    }

    void
    add_guards_of_patch(PatchSums<Number> &to) const
    {
      if (!StretchGuard<Number>::may_act(cell.stretch_factor(), cell.product_of_sums()))
        return; // nearly always
      const ThinTrace<Number> thin(cell.stretch_factor(), cell.product_of_sums());
      if (thin.acts())
        to[PatchSum::trace] += thin.supplement();
      const Number               share = Cell::traits.knows_volume ? at.importance : Number(1.);
      const StretchGuard<Number> guard(at.material.isotropic_part().scaled(share),
                                       cell.stretch_factor(), cell.product_of_sums());
      if (guard.acts())
        to[PatchSum::guard] = guard.energy();
    }

    const PointScene         &scene;
    const PointPlace<Number> &at;
    const Matrix3<Number>     D;
    const Cell                cell;
  };

  template <typename Number>
  PointPotential<Number>
  point_potential(const CellLaw law, const PointScene &scene, const PointPlace<Number> &at)
  {
    PointPotential<Number> found;
    with_potential<Number>(
        law,
        [&](auto model) {
          found = PointEvaluation<typename decltype(model)::type, Number>(law, scene, at).find();
        });
    return found;
  }
} // namespace Exemplar

#endif
