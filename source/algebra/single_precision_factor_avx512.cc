// SPDX-License-Identifier: GPL-3.0-or-later
#include <xsimd/xsimd.hpp>

#include <exemplar/algebra/single_precision_factor_loops.h>

namespace Exemplar
{
  TriangularKernels
  triangular_kernels_avx512()
  {
    return TriangularLoops<xsimd::batch<float, xsimd::avx512dq>>::kernels();
  }
} // namespace Exemplar
