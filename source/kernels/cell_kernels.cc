// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/built_instruction_sets.h>
#include <exemplar/kernels/cell_kernels.h>

namespace Exemplar
{
  namespace
  {
    template <Element element>
    std::vector<const CellKernels *>
    all_kernels_of(const ElementConstant<element> of)
    {
      static const CellKernels         baseline = cell_kernels<Instructions::baseline>(of);
      std::vector<const CellKernels *> all      = { &baseline };
      // even the function that returns the kernels is compiled with the instructions of its set
#ifdef EXEMPLAR_HAS_AVX2
      if (best_instruction_set() >= InstructionSet::avx2)
      {
        static const CellKernels avx2 = cell_kernels<Instructions::avx2>(of);
        all.push_back(&avx2);
      }
#endif
#ifdef EXEMPLAR_HAS_AVX512
      if (best_instruction_set() >= InstructionSet::avx512)
      {
        static const CellKernels avx512 = cell_kernels<Instructions::avx512>(of);
        all.push_back(&avx512);
      }
#endif
      return all;
    }
  } // namespace

  std::vector<const CellKernels *>
  all_kernels(const Element element)
  {
    return with_element(element, [](const auto of) { return all_kernels_of(of); });
  }

  const CellKernels &
  best_kernels(const Element element)
  {
    return *all_kernels(element).back();
  }
} // namespace Exemplar
