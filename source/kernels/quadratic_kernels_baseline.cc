// SPDX-License-Identifier: GPL-3.0-or-later
// The loops over quadratic cells for the instruction set that every CPU of the kind has, one by one
// and as many at once as its registers hold.
#include <exemplar/kernels/cell_kernels_loops.h>

#include <xsimd/xsimd.hpp>

namespace Exemplar
{
  template <>
  CellKernels
  cell_kernels_scalar<Element::P2>()
  {
    return Loops::make_kernels<double, Element::P2>("scalar");
  }

  template <>
  CellKernels
  cell_kernels_baseline<Element::P2>()
  {
    return Loops::make_kernels<xsimd::batch<double, xsimd::default_arch>, Element::P2>("baseline");
  }
} // namespace Exemplar
