// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_law_h
#define exemplar_loops_law_h

#include <exemplar/kernels/loops_dilatation.h>
#include <exemplar/kernels/loops_examples.h>

// What a law is given for the cells of a group.

namespace Exemplar::Loops
{
  /// Set the deformation, constants and history of the cells of a group.
  template <typename Number>
  inline void
  load_state(const CellTask             &task,
             const LawFunctions<Number> &law,
             const LaneGroup<Number>    &group,
             const Matrix3<Number>      &R,
             const Matrix3<Number>      &F,
             LawInput<Number>           &in)
  {
    in.R         = R;
    in.F         = F;
    in.constants = task.cells.constants + group.at(law.n_constants, 0);
    in.history   = task.cells.history + group.at(law.traits->n_history, 0);
    in.examples  = task.cells.examples;
    in.step_size = task.cells.step_size;
  }

  template <typename Number>
  inline void
  load_damping(const CellTask &task, const LaneGroup<Number> &group, LawInput<Number> &in)
  {
    in.is_damped = task.damping.factors != nullptr;
    if (in.is_damped)
    {
      in.damping = load(task.damping.factors, group, 1, 0);
      in.past    = load_strain(task.damping.strains, group, 1, 0);
    }
  }

  /// Set what acts on the cells of a group: examples, damping, and their patches.
  template <typename Number>
  inline void
  load_drives(const CellTask &task, const LaneGroup<Number> &group, LawInput<Number> &in)
  {
    in.has_target   = task.examples.n_weights > 0;
    in.has_pressure = task.dilatation.pressures != nullptr;
    if (in.has_target)
      in.target = target(task, group);
    load_damping(task, group, in);
    if (in.has_pressure)
      in.pressure = load(task.dilatation.pressures, group, 1, 0);
    if (task.dilatation.volume.pressures != nullptr)
      in.volume_pressure = load(task.dilatation.volume.pressures, group, 1, 0);
  }
} // namespace Exemplar::Loops

#endif
