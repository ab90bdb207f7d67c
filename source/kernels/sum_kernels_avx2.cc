// SPDX-License-Identifier: GPL-3.0-or-later
// The loops over cells of laws that are sums of others for CPUs with AVX2.
#include <exemplar/kernels/cell_kernels_loops.h>

#include <xsimd/xsimd.hpp>

namespace Exemplar
{
  template <>
  LawKernels
  sum_kernels_avx2(const ElementConstant<Element::P1> element)
  {
    return Loops::make_law_kernels<SumsOfLaws, xsimd::batch<double, xsimd::fma3<xsimd::avx2>>>(
        element);
  }

  template <>
  LawKernels
  sum_kernels_avx2(const ElementConstant<Element::P2> element)
  {
    return Loops::make_law_kernels<SumsOfLaws, xsimd::batch<double, xsimd::fma3<xsimd::avx2>>>(
        element);
  }
} // namespace Exemplar
