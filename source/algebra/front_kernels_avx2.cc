// SPDX-License-Identifier: GPL-3.0-or-later
#include <xsimd/xsimd.hpp>

#include <exemplar/algebra/front_loops.h>

namespace Exemplar
{
  template <typename Number>
  FrontKernels<Number>
  front_kernels_avx2()
  {
    return FrontLoops<xsimd::batch<Number, xsimd::fma3<xsimd::avx2>>>::kernels();
  }

  template FrontKernels<double>
  front_kernels_avx2();
  template FrontKernels<float>
  front_kernels_avx2();
} // namespace Exemplar
