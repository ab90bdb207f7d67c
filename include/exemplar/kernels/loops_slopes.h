// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_slopes_h
#define exemplar_loops_slopes_h

#include <exemplar/kernels/loops_law.h>
#include <exemplar/kernels/loops_rotations.h>

// The loops for derivatives of the potential's slope along a direction, and for strains at earlier
// positions.

namespace Exemplar::Loops
{
  /// Where the entries of a group are stored.
  template <typename Number>
  class SlopeStore
  {
  public:
    SlopeStore(const CellArrays &cells, const LaneGroup<Number> &group, double *found)
        : cells(cells), group(group), found(found)
    {
    }

    void
    set(const std::size_t entry, const Number &value) const
    {
      store(cells, group, value, found, SlopeEntry::size, entry);
    }

    void
    set(const std::size_t first, const Matrix3<Number> &A) const
    {
      for (int k = 0; k < 9; ++k)
        set(first + k, A[k / 3][k % 3]);
    }

    void
    set(const std::size_t first, const SymmetricEntries<Number> &A) const
    {
      for (std::size_t k = 0; k < n_symmetric; ++k)
        set(first + k, A[k]);
    }

  private:
    const CellArrays        &cells;
    const LaneGroup<Number> &group;
    double                  *found;
  };

  template <typename Number, int n_nodes>
  inline void
  load_slope(const CellTask             &task,
             const SlopeTask            &slope,
             const LawFunctions<Number> &law,
             const LaneGroup<Number>    &group,
             LawInput<Number>           &in,
             LawChange<Number>          &change)
  {
    const auto            tet = load_tetrahedron<n_nodes>(task.cells, group);
    const Matrix3<Number> F   = deformation_gradient(task, group, tet);
    load_state(task, law, group, load_rotation(task.cells, group), F, in);
    CellTask moves  = task;
    moves.positions = slope.along;
    change.F        = deformation_gradient(moves, group, tet);
    in.has_target   = slope.targets != nullptr;
    in.has_pressure = slope.pressures != nullptr;
    if (in.has_target)
    {
      in.target     = load_strain(slope.targets, group, 2, 0);
      change.target = load_strain(slope.targets, group, 2, 1);
    }
    if (in.has_pressure)
    {
      const auto pressure = [&](const std::size_t entry)
      { return load(slope.pressures, group, PressureEntry::size, entry); };
      in.pressure             = pressure(PressureEntry::value);
      change.pressure         = pressure(PressureEntry::change);
      change.of_target        = pressure(PressureEntry::of_target);
      change.change_of_target = pressure(PressureEntry::change_of_target);
    }
  }

  /// With arrays that are indexed as those of all cells, of `size` numbers of output a cell.
  [[gnu::always_inline]] static inline SlopeTask
  from_first_batch(SlopeTask slope, const std::size_t begin, const std::size_t size)
  {
    slope.found -= begin * batch_size * size;
    if (slope.targets != nullptr)
      slope.targets -= begin * batch_size * 2 * n_symmetric;
    if (slope.pressures != nullptr)
      slope.pressures -= begin * batch_size * PressureEntry::size;
    return slope;
  }

  template <typename Number, int n_nodes>
  inline void
  traces(const CellTask   &task,
         const SlopeTask  &of_part,
         const std::size_t begin,
         const std::size_t end)
  {
    const SlopeTask slope = from_first_batch(of_part, begin, TraceEntry::size);
    CellTask        moves = task;
    moves.positions       = slope.along;
    for_each_group_of_law<Number>(
        task.cells, begin, end,
        [&](const LaneGroup<Number> &group)
        {
          const auto            tet    = load_tetrahedron<n_nodes>(task.cells, group);
          const Matrix3<Number> R      = load_rotation(task.cells, group);
          const Matrix3<Number> F      = deformation_gradient(task, group, tet);
          const Matrix3<Number> dF     = deformation_gradient(moves, group, tet);
          const Number          of_e   = trace(corotated_strain(R, F));
          const Number          square = contract(F, F);
          const auto            set    = [&](const std::size_t entry, const Number &value)
          { store(task.cells, group, value, slope.found, TraceEntry::size, entry); };
          set(TraceEntry::value, of_e);
          set(TraceEntry::change, contract(R, dF));
          set(TraceEntry::square, square);
          set(TraceEntry::may_be_thin,
              select(may_be_thin(of_e + Number(3.), square), Number(1.), Number(0.)));
        });
  }

  template <typename Number, int n_nodes>
  inline void
  works(const CellTask   &task,
        const SlopeTask  &of_part,
        const std::size_t begin,
        const std::size_t end)
  {
    const LawFunctions<Number> &law   = law_functions<Number>(task.cells.law);
    const SlopeTask             slope = from_first_batch(of_part, begin, 1);
    LawInput<Number>            in;
    LawChange<Number>           change{};
    LawValue<Number>            value;
    for_each_group_of_law<Number>(task.cells, begin, end,
                                  [&](const LaneGroup<Number> &group)
                                  {
                                    load_slope<Number, n_nodes>(task, slope, law, group, in,
                                                                change);
                                    law.evaluate(in, false, value);
                                    store(task.cells, group,
                                          load(task.cells.volumes, group, 1, 0)
                                              * contract(value.P, transpose_times(in.R, change.F)),
                                          slope.found);
                                  });
  }

  template <typename Number, int n_nodes>
  inline void
  slopes(const CellTask   &task,
         const SlopeTask  &of_part,
         const std::size_t begin,
         const std::size_t end)
  {
    const LawFunctions<Number> &law   = law_functions<Number>(task.cells.law);
    const SlopeTask             slope = from_first_batch(of_part, begin, SlopeEntry::size);
    LawInput<Number>            in;
    LawChange<Number>           change{};
    LawSlope<Number>            of_law;
    for_each_group_of_law<Number>(
        task.cells, begin, end,
        [&](const LaneGroup<Number> &group)
        {
          load_slope<Number, n_nodes>(task, slope, law, group, in, change);
          law.slope(in, change, of_law);
          const SlopeStore<Number> to(task.cells, group, slope.found);
          const Number             V = load(task.cells.volumes, group, 1, 0);
          to.set(SlopeEntry::value, V * of_law.value);
          to.set(SlopeEntry::by_F, times(V, of_law.by_F));
          to.set(SlopeEntry::by_gradients,
                 combine(V, transpose_times(in.F, of_law.by_F), V,
                         transpose_times(change.F, of_law.by_change_of_F)));
          to.set(SlopeEntry::by_target, pack(times(V, of_law.by_target)));
          to.set(SlopeEntry::by_change_of_target, pack(times(V, of_law.by_change_of_target)));
          to.set(SlopeEntry::by_targets_size,
                 V
                     * (contract(of_law.by_target, in.target)
                        + contract(of_law.by_change_of_target, change.target)));
          for (std::size_t k = 0; k < of_law.n_constants; ++k)
            to.set(SlopeEntry::by_constants + k, V * of_law.by_constants[k]);
          to.set(SlopeEntry::by_importance, V * of_law.by_importance);
          to.set(SlopeEntry::is_guarded, select(of_law.is_guarded, Number(1.), Number(0.)));
        });
  }

  template <typename Number, int n_nodes>
  inline void
  add_strains(const CellTask   &task,
              const double      factor,
              const std::size_t begin,
              const std::size_t end,
              double           *strains,
              double           *factors)
  {
    const LawFunctions<Number> &law = law_functions<Number>(task.cells.law);
    const Number                p_0(task.cells.examples.guard_bound);
    for_each_group_of_law<Number>(
        task.cells, begin, end,
        [&](const LaneGroup<Number> &group)
        {
          const Matrix3<Number> F
              = deformation_gradient(task, group, load_tetrahedron<n_nodes>(task.cells, group));
          const Matrix3<Number> R
              = law.traits->has_rotations ? closest_rotation(F) : identity_matrix<Number>();
          const SymmetricEntries<Number> e = pack(law.strain(R, F));
          for (std::size_t k = 0; k < n_symmetric; ++k)
            store(task.cells, group, load(strains, group, n_symmetric, k) + Number(factor) * e[k],
                  strains, n_symmetric, k);
          if (!law.traits->has_guard)
            return;
          const Number p = product_of_sums(symmetric_part(transpose_times(R, F)));
          store(task.cells, group, select(p >= p_0, load(factors, group, 1, 0), Number(0.)),
                factors);
        });
  }
} // namespace Exemplar::Loops

#endif
