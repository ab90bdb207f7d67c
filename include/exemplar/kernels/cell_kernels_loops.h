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
  // See loops_io.h for which files may call these. Each element, and each group of laws, has files of
  // its own, because how much a compiler inlines depends on all that it sees.

  /// The loops of loops_*.h for a number type, an element and a group of laws.
  template <typename Laws, typename Number, Element element>
  LawKernels
  make_law_kernels(ElementConstant<element>)
  {
    constexpr int n_nodes = nodes_per_cell(element);
    return { update_rotations<Laws, Number, n_nodes>,      evaluate<Laws, Number, n_nodes>,
             weight_linear_term<Laws, Number, n_nodes>,    dilatations<Laws, Number, n_nodes>,
             stretch_energies<Laws, Number, n_nodes>,      advance_history<Laws, Number, n_nodes>,
             add_rotated_stiffness<Laws, Number, n_nodes>, add_tangent<Laws, Number, n_nodes>,
             add_patch_tangent<Laws, Number, n_nodes>,     coupling<Laws, Number, n_nodes> };
  }

  /// All loops, with those for rare laws and for sums of laws.
  template <typename Number, Element element>
  CellKernels
  make_kernels(const ElementConstant<element> of,
               const char                    *name,
               const LawKernels              &of_rare_laws,
               const LawKernels              &of_sums)
  {
    constexpr int n_nodes = nodes_per_cell(element);
    return { name,
             make_law_kernels<UsualLaws, Number>(of),
             of_rare_laws,
             of_sums,
             add_rotations<Number, n_nodes>,
             closest_rotations<Number>,
             patch_gradients<Number, n_nodes>,
             add_patch_products<Number>,
             multiply_nodes<Number> };
  }
} // namespace Exemplar::Loops

#endif
