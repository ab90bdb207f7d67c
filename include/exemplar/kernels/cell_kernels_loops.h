// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_kernels_loops_h
#define exemplar_cell_kernels_loops_h

#include <exemplar/kernels/loops_coupling.h>
#include <exemplar/kernels/loops_dilatation.h>
#include <exemplar/kernels/loops_energy.h>
#include <exemplar/kernels/loops_rotations.h>
#include <exemplar/kernels/loops_stiffness.h>
#include <exemplar/kernels/loops_tangent.h>

namespace Exemplar::Loops
{
  /// The loops of loops_*.h for a number type; see loops_io.h for which files may call this.
  template <typename Number>
  CellKernels
  make_kernels(const char *name)
  {
    return { name,
             update_rotations<Number>,
             add_rotations<Number>,
             closest_rotations<Number>,
             evaluate<Number>,
             weight_linear_term<Number>,
             dilatations<Number>,
             add_pressure_forces<Number>,
             add_rotated_stiffness<Number>,
             add_tangent<Number>,
             coupling<Number> };
  }
} // namespace Exemplar::Loops

#endif
