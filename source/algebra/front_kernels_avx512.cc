// SPDX-License-Identifier: GPL-3.0-or-later
#include <xsimd/xsimd.hpp>

#include <exemplar/algebra/front_loops.h>

namespace Exemplar
{
  template <typename Number>
  FrontKernels<Number>
  front_kernels_avx512()
  {
    return FrontLoops<xsimd::batch<Number, xsimd::avx512dq>>::kernels();
  }

  template FrontKernels<double>
  front_kernels_avx512();
  template FrontKernels<float>
  front_kernels_avx512();
} // namespace Exemplar
