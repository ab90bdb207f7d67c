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

  /// Add the pressure of its patch along cof F to a cell, Eq. (37).
  template <typename Cell, typename Number>
  [[gnu::always_inline]] inline void
  add_volume_pressure(const CellTask &task, const LaneGroup<Number> &group, Cell &cell)
  {
    if constexpr (Cell::traits.has_volumetric_energy)
      if (task.dilatation.volume.pressures != nullptr)
        cell.add_volume_pressure(load(task.dilatation.volume.pressures, group, 1, 0));
  }

  /// Stress of a patch in its cells; zero where there is none.
  template <typename Number>
  struct PatchStress
  {
    bool   acts     = false;
    Number pressure = Number(0.), scale = Number(0.);
  };

  template <typename Cell, typename Number>
  inline PatchStress<Number>
  patch_stress(const CellTask &task, const LaneGroup<Number> &group)
  {
    if constexpr (Cell::traits.trace_gradient_is_R)
      if (task.dilatation.pressures != nullptr)
        return { true, load(task.dilatation.pressures, group, 1, 0),
                 load(task.dilatation.scales, group, 1, 0) };
    return {};
  }

  template <typename Cell, typename Number>
  [[gnu::always_inline]] inline void
  store_dilatation(const CellTask          &task,
                   const LaneGroup<Number> &group,
                   const Matrix3<Number>   &strain,
                   const Matrix3<Number>   &F)
  {
    Number       of_strain = trace(strain);
    const Number square    = contract(F, F);
    store(task.cells, group, square, task.dilatation.squares);
    if constexpr (Cell::traits.has_volumetric_energy)
      store_volume(task, group, strain, F);
    if constexpr (Cell::traits.has_guard_of_patches())
    {
      if (any(square > Number(min_stretched_square)))
        task.dilatation.flags[group.batch] |= long_cells;
      if (any(may_be_thin(of_strain + Number(3.), square)))
        of_strain += supplement_of_thin(task, group, strain);
    }
    store(task.cells, group, of_strain, task.dilatation.traces);
  }

  template <typename Laws, typename Number, int n_nodes>
  inline void
  dilatations(const CellTask &task, const std::size_t begin, const std::size_t end)
  {
    with_cell_model<Number>(
        Laws(), task.cells.law,
        [&](auto model)
        {
          using Cell = typename decltype(model)::type;
          if constexpr (Cell::traits.trace_gradient_is_R)
            for_each_group_of_law<Number>(
                task.cells, begin, end,
                [&](const LaneGroup<Number> &group)
                {
                  const Matrix3<Number> F = deformation_gradient(
                      task, group, load_tetrahedron<n_nodes>(task.cells, group));
                  store_dilatation<Cell>(task, group,
                                         Cell::strain_of(rotation<Cell>(task, group, F), F), F);
                });
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

  template <typename Cell, typename Number>
  inline PatchCell<Number, Cell>
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
    Cell cell = make_cell<Cell>(task.cells, group, R, F);
    cell.set_target(Matrix3<Number>{});
    return PatchCell<Number, Cell>(cell, patch);
  }

  template <typename Laws, typename Number, int n_nodes>
  inline void
  stretch_energies(const CellTask &task, const std::size_t begin, const std::size_t end)
  {
    with_cell_model<Number>(
        Laws(), task.cells.law,
        [&](auto model)
        {
          using Cell = typename decltype(model)::type;
          if constexpr (Cell::traits.has_guard_of_patches())
            for_each_group_of_law<Number>(
                task.cells, begin, end,
                [&](const LaneGroup<Number> &group)
                {
                  if (!is_stretched(task.dilatation.stretch, group))
                    return;
                  const Matrix3<Number> F = deformation_gradient(
                      task, group, load_tetrahedron<n_nodes>(task.cells, group));
                  const auto cell
                      = patch_cell<Cell>(task, group, load_rotation(task.cells, group), F);
                  store(task.cells, group, cell.guard_energy(), task.dilatation.stretch.energies);
                });
        });
  }
} // namespace Exemplar::Loops

#endif
