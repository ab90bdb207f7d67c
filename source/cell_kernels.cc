// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/cell_kernels_loops.h>

namespace Exemplar
{
#ifdef __x86_64__
  CellKernels
  cell_kernels_avx512();
  CellKernels
  cell_kernels_avx2();
#endif
  CellKernels
  cell_kernels_baseline();

  std::vector<const CellKernels *>
  all_kernels()
  {
    static const CellKernels         scalar   = CellLoops<double>::kernels("scalar");
    static const CellKernels         baseline = cell_kernels_baseline();
    std::vector<const CellKernels *> all      = { &scalar, &baseline };
#ifdef __x86_64__
    // the levels x86-64-v3 and v4
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")
        && __builtin_cpu_supports("bmi2"))
    {
      static const CellKernels avx2 = cell_kernels_avx2();
      all.push_back(&avx2);
    }
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")
        && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
    {
      static const CellKernels avx512 = cell_kernels_avx512();
      all.push_back(&avx512);
    }
#endif
    return all;
  }

  const CellKernels &
  best_kernels()
  {
    return *all_kernels().back();
  }
} // namespace Exemplar
