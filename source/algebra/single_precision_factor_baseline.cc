// SPDX-License-Identifier: GPL-3.0-or-later
#include <xsimd/xsimd.hpp>

#include <exemplar/algebra/single_precision_factor_loops.h>

namespace Exemplar
{
  TriangularKernels
  triangular_kernels_baseline()
  {
    return TriangularLoops<xsimd::batch<float, xsimd::default_arch>>::kernels();
  }
} // namespace Exemplar
