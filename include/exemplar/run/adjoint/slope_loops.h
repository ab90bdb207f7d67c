// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_slope_loops_h
#define exemplar_slope_loops_h

#include <exemplar/algebra/padded_nodes.h>
#include <exemplar/base/loop_parts.h>
#include <exemplar/kernels/point_shape.h>
#include <exemplar/kernels/symmetric.h>
#include <exemplar/potential/cell_field.h>

#include <deal.II/base/aligned_vector.h>

#include <algorithm>
#include <array>

// The derivatives of a slope in bodies whose points have the energies of their laws alone, and the
// pressures of patches, by the loops over the cells.

namespace Exemplar
{
  /// What a loop has found at a point; see SlopeEntry.
  class FoundSlope
  {
  public:
    FoundSlope(const double *found, const std::size_t slot) : found(found), slot(slot) {}

    double
    operator[](const std::size_t entry) const
    {
      return found[batch_index(slot, SlopeEntry::size, entry)];
    }

    Matrix3<double>
    matrix(const std::size_t first) const
    {
      Matrix3<double> A;
      for (int k = 0; k < 9; ++k)
        A[k / 3][k % 3] = (*this)[first + k];
      return A;
    }

    Matrix3<double>
    symmetric_matrix(const std::size_t first) const
    {
      SymmetricEntries<double> A;
      for (std::size_t k = 0; k < n_symmetric; ++k)
        A[k] = (*this)[first + k];
      return unpack(A);
    }

  private:
    const double *found;
    std::size_t   slot;
  };

  /// The numbers of PressureEntry.
  using PointPressures = std::array<double, PressureEntry::size>;

  /// What acts at the points of a slope: target(point), a MatrixAlong, and pressures(point),
  /// PointPressures; either may be left out.
  template <typename Target, typename Pressures>
  struct SlopeDrives
  {
    bool      has_targets;
    Target    target;
    bool      has_pressures;
    Pressures pressures;
  };

  template <typename Target, typename Pressures>
  SlopeDrives(bool, Target, bool, Pressures) -> SlopeDrives<Target, Pressures>;

  /// The loops over the cells of a body that find the slope of its laws' energies along a direction.
  class SlopeLoops
  {
  public:
    /// At these positions, whose rotations the field has, along these changes, with the laws of
    /// damping() instead of the body's or not. The field must outlive it.
    SlopeLoops(CellField    &field,
               const Vector &positions,
               const Vector &along,
               const bool    of_damping)
        : field(field), of_damping(of_damping), task(field.task(positions, RotationUse::keep)),
          changes(4 * field.n_nodes())
    {
      task.damping    = {};
      task.dilatation = {};
      pad_nodes(along, changes);
    }

    /// The law whose energy is that of damping: a background's own energy has none.
    static CellLaw
    damping(const CellLaw law)
    {
      return traits_of(law).has_volumetric_energy ? CellLaw::corotational : law;
    }

    /// Call take(point, FoundSlope) for all points in their order, with these SlopeDrives.
    template <typename Drives, typename Take>
    void
    for_each_slope(const Drives &drives, const Take &take)
    {
      for_each_chunk(drives, SlopeEntry::size, &CellKernels::slopes,
                     [&](const unsigned int point, const double *found, const std::size_t slot)
                     { take(point, FoundSlope(found, slot)); });
    }

    /// Call take(point, slope) likewise, with the slope alone, without the guard of the stretch.
    template <typename Drives, typename Take>
    void
    for_each_work(const Drives &drives, const Take &take)
    {
      for_each_chunk(drives, 1, &CellKernels::works,
                     [&](const unsigned int point, const double *found, const std::size_t slot)
                     { take(point, found[slot]); });
    }

    /// Call take(point, trace) likewise, where trace(entry) is a TraceEntry.
    template <typename Take>
    void
    for_each_trace(const Take &take)
    {
      const auto nothing = [](const unsigned int /*point*/) { return MatrixAlong(); };
      const auto none    = [](const unsigned int /*point*/) { return PointPressures(); };
      for_each_chunk(SlopeDrives{ false, nothing, false, none }, TraceEntry::size,
                     &CellKernels::traces,
                     [&](const unsigned int point, const double *found, const std::size_t slot)
                     {
                       take(point, [&](const std::size_t entry)
                            { return found[batch_index(slot, TraceEntry::size, entry)]; });
                     });
    }

  private:
    static constexpr std::size_t n_batches_at_once = 64, n_parts = 16; ///< whatever the threads
    static constexpr std::size_t n_of_targets = 2 * n_symmetric;

    using Loop
        = void (*CellKernels::*)(const CellTask &, const SlopeTask &, std::size_t, std::size_t);

    template <typename Drives, typename Take>
    void
    for_each_chunk(const Drives &drives, const std::size_t size, const Loop loop, const Take &take)
    {
      const std::size_t n_points = task.cells.n_cells, n_batches = task.cells.n_batches();
      targets.resize_fast(drives.has_targets ? n_batches_at_once * batch_size * n_of_targets : 0);
      pressures.resize_fast(
          drives.has_pressures ? n_batches_at_once * batch_size * PressureEntry::size : 0);
      found.resize_fast(n_batches_at_once * batch_size * size);
      const auto target_numbers
          = [&](const unsigned int point) { return packed(drives.target(point)); };
      for (std::size_t first = 0; first < n_batches; first += n_batches_at_once)
      {
        const std::size_t n     = std::min(n_batches_at_once, n_batches - first);
        const std::size_t begin = first * batch_size;
        for_each_part(n_parts, n, field.n_threads(),
                      [&](const std::size_t, const std::size_t from, const std::size_t to)
                      {
                        if (drives.has_targets)
                          set(begin, from * batch_size, to * batch_size, target_numbers, targets);
                        if (drives.has_pressures)
                          set(begin, from * batch_size, to * batch_size, drives.pressures,
                              pressures);
                        run(loop, size, first, from, to);
                      });
        for (std::size_t slot = 0; slot < n * batch_size && begin + slot < n_points; ++slot)
          take(static_cast<unsigned int>(begin + slot), found.data(), slot);
      }
    }

    /// Set the entries of the slots `begin` to `end` - 1, of which slot 0 is slot `first` of the body, to
    /// numbers_of(point).
    template <typename NumbersOf>
    void
    set(const std::size_t              first,
        const std::size_t              begin,
        const std::size_t              end,
        const NumbersOf               &numbers_of,
        dealii::AlignedVector<double> &entries)
    {
      for (std::size_t slot = begin; slot < end; ++slot)
      {
        const auto numbers = numbers_of(point_of(first + slot));
        for (std::size_t k = 0; k < numbers.size(); ++k)
          entries[batch_index(slot, numbers.size(), k)] = numbers[k];
      }
    }

    /// The entries of a target and its change.
    static std::array<double, n_of_targets>
    packed(const MatrixAlong &D)
    {
      const SymmetricEntries<double>   value = pack(D.value), change = pack(D.change);
      std::array<double, n_of_targets> numbers;
      for (std::size_t k = 0; k < n_symmetric; ++k)
      {
        numbers[k]               = value[k];
        numbers[n_symmetric + k] = change[k];
      }
      return numbers;
    }

    /// The last batch is filled with copies of the last cell.
    unsigned int
    point_of(const std::size_t slot) const
    {
      return static_cast<unsigned int>(std::min(slot, task.cells.n_cells - 1));
    }

    /// For batches `from` to `to` - 1 of those from `first` on.
    void
    run(const Loop        loop,
        const std::size_t size,
        const std::size_t first,
        const std::size_t from,
        const std::size_t to)
    {
      SlopeTask slope{ changes.data(), nullptr, &found[from * batch_size * size] };
      if (!pressures.empty())
        slope.pressures = &pressures[from * batch_size * PressureEntry::size];
      if (!targets.empty())
        slope.targets = &targets[from * batch_size * n_of_targets];
      field.for_each_law(task,
                         [&](CellTask of_law)
                         {
                           if (of_damping)
                             of_law.cells.law = damping(of_law.cells.law);
                           (field.loops().*loop)(of_law, slope, first + from, first + to);
                         });
    }

    CellField                    &field;
    const bool                    of_damping;
    CellTask                      task;
    dealii::AlignedVector<double> changes; ///< four numbers a node
    dealii::AlignedVector<double> targets, pressures, found;
  };
} // namespace Exemplar

#endif
