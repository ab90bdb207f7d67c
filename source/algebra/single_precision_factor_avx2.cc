// SPDX-License-Identifier: GPL-3.0-or-later
#include <xsimd/xsimd.hpp>

#include <exemplar/algebra/single_precision_factor_loops.h>

namespace Exemplar
{
  TriangularKernels
  triangular_kernels_avx2()
  {
    return TriangularLoops<xsimd::batch<float, xsimd::fma3<xsimd::avx2>>>::kernels();
  }
} // namespace Exemplar
