// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_slope_loops_h
#define exemplar_slope_loops_h

#include <exemplar/base/loop_parts.h>
#include <exemplar/kernels/point_shape.h>
#include <exemplar/kernels/symmetric.h>
#include <exemplar/potential/cell_field.h>

#include <deal.II/base/aligned_vector.h>

#include <algorithm>

// The derivatives of a slope in bodies whose points have the energies of their laws alone, by the
// loops over the cells.

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
      for (unsigned int node = 0; node < field.n_nodes(); ++node)
        for (unsigned int c = 0; c < 3; ++c)
          changes[4 * node + c] = along[3 * node + c];
    }

    /// The law whose energy is that of damping: a background's own energy has none.
    static CellLaw
    damping(const CellLaw law)
    {
      return traits_of(law).has_volumetric_energy ? CellLaw::corotational : law;
    }

    /// Call take(point, FoundSlope) for all points in their order. Points have the targets
    /// target(point), a MatrixAlong, or none.
    template <typename Target, typename Take>
    void
    for_each_slope(const bool has_targets, const Target &target, const Take &take)
    {
      for_each_chunk(has_targets, target, SlopeEntry::size, &CellKernels::slopes,
                     [&](const unsigned int point, const double *found, const std::size_t slot)
                     { take(point, FoundSlope(found, slot)); });
    }

    /// Call take(point, slope) likewise, with the slope alone, without the guard of the stretch.
    template <typename Target, typename Take>
    void
    for_each_work(const Target &target, const Take &take)
    {
      for_each_chunk(true, target, 1, &CellKernels::works,
                     [&](const unsigned int point, const double *found, const std::size_t slot)
                     { take(point, found[slot]); });
    }

  private:
    static constexpr std::size_t n_batches_at_once = 64, n_parts = 16; ///< whatever the threads

    using Loop
        = void (*CellKernels::*)(const CellTask &, const SlopeTask &, std::size_t, std::size_t);

    template <typename Target, typename Take>
    void
    for_each_chunk(const bool        has_targets,
                   const Target     &target,
                   const std::size_t size,
                   const Loop        loop,
                   const Take       &take)
    {
      const std::size_t n_points = task.cells.n_cells, n_batches = task.cells.n_batches();
      targets.resize_fast(has_targets ? n_batches_at_once * batch_size * n_of_targets : 0);
      found.resize_fast(n_batches_at_once * batch_size * size);
      for (std::size_t first = 0; first < n_batches; first += n_batches_at_once)
      {
        const std::size_t n     = std::min(n_batches_at_once, n_batches - first);
        const std::size_t begin = first * batch_size;
        for_each_part(n_parts, n, field.n_threads(),
                      [&](const std::size_t, const std::size_t from, const std::size_t to)
                      {
                        if (has_targets)
                          set_targets(begin, from * batch_size, to * batch_size, target);
                        run(loop, size, first, from, to);
                      });
        for (std::size_t slot = 0; slot < n * batch_size && begin + slot < n_points; ++slot)
          take(static_cast<unsigned int>(begin + slot), found.data(), slot);
      }
    }

    template <typename Target>
    void
    set_targets(const std::size_t first,
                const std::size_t begin,
                const std::size_t end,
                const Target     &target)
    {
      for (std::size_t slot = begin; slot < end; ++slot)
      {
        // the last batch is filled with copies of the last cell
        const std::size_t              point = std::min(first + slot, task.cells.n_cells - 1);
        const MatrixAlong              D     = target(static_cast<unsigned int>(point));
        const SymmetricEntries<double> value = pack(D.value), change = pack(D.change);
        for (std::size_t k = 0; k < n_symmetric; ++k)
        {
          targets[batch_index(slot, n_of_targets, k)]               = value[k];
          targets[batch_index(slot, n_of_targets, n_symmetric + k)] = change[k];
        }
      }
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

    static constexpr std::size_t n_of_targets = 2 * n_symmetric;

    CellField                    &field;
    const bool                    of_damping;
    CellTask                      task;
    dealii::AlignedVector<double> changes; ///< four numbers a node
    dealii::AlignedVector<double> targets, found;
  };
} // namespace Exemplar

#endif
