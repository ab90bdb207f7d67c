// SPDX-License-Identifier: GPL-3.0-or-later
// The loops over linear cells for CPUs with AVX512.
#include <exemplar/kernels/cell_kernels_loops.h>

#include <xsimd/xsimd.hpp>

namespace Exemplar
{
  template <>
  CellKernels
  cell_kernels_avx512(const ElementConstant<Element::P1> element)
  {
    return Loops::make_kernels<xsimd::batch<double, xsimd::avx512dq>>(
        element, "avx512", rare_law_kernels_avx512(element), sum_kernels_avx512(element));
  }
} // namespace Exemplar
