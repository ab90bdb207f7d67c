// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_kernels_loops_h
#define exemplar_cell_kernels_loops_h

#include <exemplar/kernels/loops_coupling.h>
#include <exemplar/kernels/loops_dilatation.h>
#include <exemplar/kernels/loops_energy.h>
#include <exemplar/kernels/loops_nodes.h>
#include <exemplar/kernels/loops_patches.h>
#include <exemplar/kernels/loops_rotations.h>
#include <exemplar/kernels/loops_stiffness.h>
#include <exemplar/kernels/loops_tangent.h>

namespace Exemplar::Loops
{
  /// The loops of loops_*.h for a number type and an element; see loops_io.h for which files may
  /// call this. Each element has files of its own, because how much a compiler inlines depends on
  /// all that it sees.
  template <typename Number, Element element>
  CellKernels
  make_kernels(ElementConstant<element>, const char *name)
  {
    constexpr int n_nodes = nodes_per_cell(element);
    return { name,
             update_rotations<Number, n_nodes>,
             add_rotations<Number, n_nodes>,
             closest_rotations<Number>,
             evaluate<Number, n_nodes>,
             weight_linear_term<Number, n_nodes>,
             dilatations<Number, n_nodes>,
             stretch_energies<Number, n_nodes>,
             advance_history<Number, n_nodes>,
             add_rotated_stiffness<Number, n_nodes>,
             add_tangent<Number, n_nodes>,
             add_patch_tangent<Number, n_nodes>,
             patch_gradients<Number, n_nodes>,
             add_patch_products<Number>,
             multiply_nodes<Number>,
             coupling<Number, n_nodes> };
  }
} // namespace Exemplar::Loops

#endif
