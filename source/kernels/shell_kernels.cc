// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/built_instruction_sets.h>
#include <exemplar/kernels/shell_kernels.h>

namespace Exemplar
{
  ShellKernels
  shell_kernels_baseline();
  ShellKernels
  shell_kernels_avx2();
  ShellKernels
  shell_kernels_avx512();

  const ShellKernels &
  shell_kernels()
  {
    static const ShellKernels kernels = []
    {
      switch (built_instruction_set())
      {
#ifdef EXEMPLAR_HAS_AVX512
      case InstructionSet::avx512:
        return shell_kernels_avx512();
#endif
#ifdef EXEMPLAR_HAS_AVX2
      case InstructionSet::avx2:
        return shell_kernels_avx2();
#endif
      default:
        return shell_kernels_baseline();
      }
    }();
    return kernels;
  }
} // namespace Exemplar
