// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_kernels_loops_h
#define exemplar_cell_kernels_loops_h

#include <exemplar/kernels/loops_energy.h>
#include <exemplar/kernels/loops_fibres.h>
#include <exemplar/kernels/loops_nodes.h>
#include <exemplar/kernels/loops_patches.h>
#include <exemplar/kernels/loops_slopes.h>
#include <exemplar/kernels/loops_tangent.h>

namespace Exemplar::Loops
{
  // See loops_io.h for which files may call this.

  /// The loops of loops_*.h for a number type and an element.
  template <typename Number, Element element>
  CellKernels
  make_kernels(const ElementConstant<element> /*element*/, const char *name)
  {
    constexpr int n_nodes = nodes_per_cell(element);
    return { name,
             update_rotations<Number, n_nodes>,
             evaluate<Number, n_nodes>,
             weight_linear_term<Number, n_nodes>,
             dilatations<Number, n_nodes>,
             stretch_energies<Number, n_nodes>,
             advance_history<Number, n_nodes>,
             add_tangent<Number, n_nodes>,
             add_patch_tangent<Number, n_nodes>,
             coupling<Number, n_nodes>,
             slopes<Number, n_nodes>,
             works<Number, n_nodes>,
             traces<Number, n_nodes>,
             add_strains<Number, n_nodes>,
             add_rotations<Number, n_nodes>,
             closest_rotations<Number>,
             patch_gradients<Number, n_nodes>,
             add_patch_products<Number>,
             multiply_nodes<Number>,
             fibre_vectors<Number, n_nodes>,
             pull_fibres<Number>,
             add_fibre_forces<Number, n_nodes> };
  }
} // namespace Exemplar::Loops

#endif
