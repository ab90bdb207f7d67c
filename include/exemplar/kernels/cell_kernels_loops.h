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
  // See loops_io.h for which files may call these.

  /// The loops of loops_*.h for a number type, a group of laws and an element.
  template <typename Number, typename Laws, Element element>
  LawKernels
  make_law_kernels(const Laws /*laws*/, const ElementConstant<element> /*element*/)
  {
    constexpr int n_nodes = nodes_per_cell(element);
    return { update_rotations<Laws, Number, n_nodes>,      evaluate<Laws, Number, n_nodes>,
             weight_linear_term<Laws, Number, n_nodes>,    dilatations<Laws, Number, n_nodes>,
             stretch_energies<Laws, Number, n_nodes>,      advance_history<Laws, Number, n_nodes>,
             add_rotated_stiffness<Laws, Number, n_nodes>, add_tangent<Laws, Number, n_nodes>,
             add_patch_tangent<Laws, Number, n_nodes>,     coupling<Laws, Number, n_nodes> };
  }

  /// The kernels of an instruction set: loops compiled here, and those of other groups of laws from
  /// their own files.
  template <typename Set, typename Number, Element element>
  CellKernels
  make_kernels(const ElementConstant<element> of, const char *name)
  {
    constexpr int n_nodes = nodes_per_cell(element);
    return { name,
             make_law_kernels<Number>(UsualLaws(), of),
             law_kernels<Set>(RareLaws(), of),
             law_kernels<Set>(SumsOfLaws(), of),
             add_rotations<Number, n_nodes>,
             closest_rotations<Number>,
             patch_gradients<Number, n_nodes>,
             add_patch_products<Number>,
             multiply_nodes<Number> };
  }
} // namespace Exemplar::Loops

#endif
