// SPDX-License-Identifier: GPL-3.0-or-later
// The loops over quadratic cells of rare laws for CPUs with AVX512.
#include <exemplar/kernels/cell_kernels_loops.h>

#include <xsimd/xsimd.hpp>

namespace Exemplar
{
  template <>
  LawKernels
  rare_law_kernels_avx512(const ElementConstant<Element::P2> element)
  {
    return Loops::make_law_kernels<RareLaws, xsimd::batch<double, xsimd::avx512dq>>(element);
  }
} // namespace Exemplar
