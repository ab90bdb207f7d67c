// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_dilatation_h
#define exemplar_loops_dilatation_h

#include <exemplar/kernels/loops_rotations.h>
#include <exemplar/kernels/patch_cell.h>

// The cells' contributions to patches, Eqs. (25) and (26), before the patches' pressures are known.

namespace Exemplar::Loops
{
  /// The supplement r of ThinTrace in the cells of a group. Not inlined, as hardly any cell needs
  /// it.
  template <typename Number>
  [[gnu::noinline, gnu::cold]] Number
  supplement_of_thin(const CellTask          &task,
                     const LaneGroup<Number> &group,
                     const Matrix3<Number>   &strain)
  {
    const auto thin = ThinTrace<Number>::of_strain(strain);
    if (thin.acts())
      task.dilatation.flags[group.batch] |= thin_cells;
    return thin.supplement();
  }

  template <typename Number>
  inline void
  store_volume(const CellTask          &task,
               const LaneGroup<Number> &group,
               const Matrix3<Number>   &strain,
               const Matrix3<Number>   &F)
  {
    const VolumeArrays &to = task.dilatation.volume;
    if (to.changes == nullptr)
      return;
    store(task.cells, group, volume_change(strain), to.changes);
    const Matrix3<Number> cof = cofactors(F);
    for (int k = 0; k < 9; ++k)
      store(task.cells, group, cof[k / 3][k % 3], to.cofactors, 9, k);
  }

  /// Store what patches need of the strain and F of the cells of a group.
  template <typename Number>
  [[gnu::always_inline]] inline void
  store_dilatation(const CellTask          &task,
                   const ModelTraits       &law,
                   const LaneGroup<Number> &group,
                   const Matrix3<Number>   &strain,
                   const Matrix3<Number>   &F)
  {
    Number       of_strain = trace(strain);
    const Number square    = contract(F, F);
    store(task.cells, group, square, task.dilatation.squares);
    if (law.has_volumetric_energy)
      store_volume(task, group, strain, F);
    if (law.has_guard_of_patches())
    {
      if (any(square > Number(min_stretched_square)))
        task.dilatation.flags[group.batch] |= long_cells;
      if (any(may_be_thin(of_strain + Number(3.), square)))
        of_strain += supplement_of_thin(task, group, strain);
    }
    store(task.cells, group, of_strain, task.dilatation.traces);
  }

  template <typename Number, int n_nodes>
  [[gnu::flatten]] inline void
  dilatations(const CellTask &task, const std::size_t begin, const std::size_t end)
  {
    const LawFunctions<Number> &law = law_functions<Number>(task.cells.law);
    if (!law.traits->trace_gradient_is_R)
      return;
    for_each_group_of_law<Number>(
        task.cells, begin, end,
        [&](const LaneGroup<Number> &group)
        {
          const Matrix3<Number> F
              = deformation_gradient(task, group, load_tetrahedron<n_nodes>(task.cells, group));
          store_dilatation(task, *law.traits, group,
                           corotated_strain(rotation(task, law, group, F), F), F);
        });
  }

  template <typename Number>
  inline bool
  is_stretched(const StretchArrays &stretch, const LaneGroup<Number> &group)
  {
    return stretch.transitions != nullptr
           && any(load(stretch.transitions, group, 1, 0) > Number(0.));
  }

  /// Whether a patch adds more than a pressure to some cell of a group.
  template <typename Number>
  inline bool
  is_special(const DilatationArrays &dilatation, const LaneGroup<Number> &group)
  {
    return (dilatation.flags[group.batch] & thin_cells) != 0
           || is_stretched(dilatation.stretch, group);
  }

  template <typename Number>
  inline PatchCell<Number>
  patch_cell(const CellTask          &task,
             const LaneGroup<Number> &group,
             const Matrix3<Number>   &R,
             const Matrix3<Number>   &F)
  {
    const StretchArrays   &stretch = task.dilatation.stretch;
    StretchedPatch<Number> patch{ Number(0.), Number(0.), Number(0.), { Number(0.), Number(0.) } };
    if (stretch.transitions != nullptr)
      patch = { load(stretch.transitions, group, 1, 0),
                load(stretch.by_F, group, 1, 0),
                load(stretch.stiffnesses, group, 1, 0),
                { load(stretch.elasticity, group, 2, 0), load(stretch.elasticity, group, 2, 1) } };
    return PatchCell<Number>(R, F, task.cells.examples, patch);
  }

  template <typename Number, int n_nodes>
  inline void
  stretch_energies(const CellTask &task, const std::size_t begin, const std::size_t end)
  {
    if (!law_functions<Number>(task.cells.law).traits->has_guard_of_patches())
      return;
    for_each_group_of_law<Number>(
        task.cells, begin, end,
        [&](const LaneGroup<Number> &group)
        {
          if (!is_stretched(task.dilatation.stretch, group))
            return;
          const Matrix3<Number> F
              = deformation_gradient(task, group, load_tetrahedron<n_nodes>(task.cells, group));
          const auto cell = patch_cell(task, group, load_rotation(task.cells, group), F);
          store(task.cells, group, cell.guard_energy(), task.dilatation.stretch.energies);
        });
  }
} // namespace Exemplar::Loops

#endif
