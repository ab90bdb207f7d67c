// SPDX-License-Identifier: GPL-3.0-or-later
#include <xsimd/xsimd.hpp>

#include <exemplar/kernels/shell_loops.h>

namespace Exemplar
{
  ShellKernels
  shell_kernels_avx512()
  {
    return ShellLoops<xsimd::batch<double, xsimd::avx512dq>>::kernels();
  }
} // namespace Exemplar
