// SPDX-License-Identifier: GPL-3.0-or-later
// The loops over quadratic cells for the instruction set that every CPU of the kind has, one by one
// and as many at once as its registers hold.
#include <exemplar/kernels/cell_kernels_loops.h>

#include <xsimd/xsimd.hpp>

namespace Exemplar
{
  template <>
  CellKernels
  cell_kernels_scalar(const ElementConstant<Element::P2> element)
  {
    return Loops::make_kernels<double>(element, "scalar", rare_law_kernels_scalar(element),
                                       sum_kernels_scalar(element));
  }

  template <>
  CellKernels
  cell_kernels_baseline(const ElementConstant<Element::P2> element)
  {
    return Loops::make_kernels<xsimd::batch<double, xsimd::default_arch>>(
        element, "baseline", rare_law_kernels_baseline(element), sum_kernels_baseline(element));
  }
} // namespace Exemplar
