// SPDX-License-Identifier: GPL-3.0-or-later
#include <xsimd/xsimd.hpp>

#include <exemplar/kernels/shell_loops.h>

namespace Exemplar
{
  ShellKernels
  shell_kernels_avx2()
  {
    return ShellLoops<xsimd::batch<double, xsimd::fma3<xsimd::avx2>>>::kernels();
  }
} // namespace Exemplar
