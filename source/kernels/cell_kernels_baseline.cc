// SPDX-License-Identifier: GPL-3.0-or-later
// The loops over the cells for the instruction set that every CPU of the kind has.
#include <exemplar/kernels/cell_kernels_loops.h>

#include <xsimd/xsimd.hpp>

namespace Exemplar
{
  CellKernels
  cell_kernels_baseline()
  {
    return CellLoops<xsimd::batch<double, xsimd::default_arch>>::kernels("baseline");
  }
} // namespace Exemplar
