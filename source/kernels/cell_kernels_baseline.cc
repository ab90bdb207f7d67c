// SPDX-License-Identifier: GPL-3.0-or-later
// The loops over the cells for the instruction set that every CPU of the kind has, one by one
// and as many at once as its registers hold.
#include <exemplar/kernels/cell_kernels_loops.h>

#include <xsimd/xsimd.hpp>

namespace Exemplar
{
  CellKernels
  cell_kernels_scalar()
  {
    return Loops::make_kernels<double>("scalar");
  }

  CellKernels
  cell_kernels_baseline()
  {
    return Loops::make_kernels<xsimd::batch<double, xsimd::default_arch>>("baseline");
  }
} // namespace Exemplar
