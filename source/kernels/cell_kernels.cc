// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/instruction_set.h>
#include <exemplar/kernels/cell_kernels.h>

namespace Exemplar
{
  CellKernels
  cell_kernels_scalar();
  CellKernels
  cell_kernels_baseline();
#ifdef __x86_64__
  CellKernels
  cell_kernels_avx2();
  CellKernels
  cell_kernels_avx512();
#endif

  std::vector<const CellKernels *>
  all_kernels()
  {
    static const CellKernels         scalar   = cell_kernels_scalar();
    static const CellKernels         baseline = cell_kernels_baseline();
    std::vector<const CellKernels *> all      = { &scalar, &baseline };
#ifdef __x86_64__
    // even the function that names the loops is compiled with the instructions of its set
    if (best_instruction_set() >= InstructionSet::avx2)
    {
      static const CellKernels avx2 = cell_kernels_avx2();
      all.push_back(&avx2);
    }
    if (best_instruction_set() >= InstructionSet::avx512)
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
