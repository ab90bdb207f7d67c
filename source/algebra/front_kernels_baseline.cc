// SPDX-License-Identifier: GPL-3.0-or-later
#include <xsimd/xsimd.hpp>

#include <exemplar/algebra/front_loops.h>

namespace Exemplar
{
  template <typename Number>
  FrontKernels<Number>
  front_kernels_baseline()
  {
    return FrontLoops<xsimd::batch<Number, xsimd::default_arch>>::kernels();
  }

  template FrontKernels<double>
  front_kernels_baseline();
  template FrontKernels<float>
  front_kernels_baseline();
} // namespace Exemplar
