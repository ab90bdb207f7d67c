// SPDX-License-Identifier: GPL-3.0-or-later
// The loops over linear cells for CPUs with AVX2.
#include <exemplar/kernels/cell_kernels_loops.h>

#include <xsimd/xsimd.hpp>

namespace Exemplar
{
  template <>
  CellKernels
  cell_kernels_avx2(const ElementConstant<Element::P1> element)
  {
    return Loops::make_kernels<xsimd::batch<double, xsimd::fma3<xsimd::avx2>>>(
        element, "avx2", rare_law_kernels_avx2(element), sum_kernels_avx2(element));
  }
} // namespace Exemplar
