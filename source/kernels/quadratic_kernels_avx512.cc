// SPDX-License-Identifier: GPL-3.0-or-later
// The loops over quadratic cells for CPUs with AVX512.
#include <exemplar/kernels/cell_kernels_loops.h>

#include <xsimd/xsimd.hpp>

namespace Exemplar
{
  template <>
  CellKernels
  cell_kernels_avx512<Element::P2>()
  {
    return Loops::make_kernels<xsimd::batch<double, xsimd::avx512dq>, Element::P2>("avx512");
  }
} // namespace Exemplar
