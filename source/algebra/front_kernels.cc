// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/front_kernels.h>
#include <exemplar/base/built_instruction_sets.h>

namespace Exemplar
{
  template <typename Number>
  FrontKernels<Number>
  front_kernels_baseline();
  template <typename Number>
  FrontKernels<Number>
  front_kernels_avx2();
  template <typename Number>
  FrontKernels<Number>
  front_kernels_avx512();

  namespace
  {
    template <typename Number>
    FrontKernels<Number>
    choose_kernels()
    {
      switch (built_instruction_set())
      {
#ifdef EXEMPLAR_HAS_AVX512
      case InstructionSet::avx512:
        return front_kernels_avx512<Number>();
#endif
#ifdef EXEMPLAR_HAS_AVX2
      case InstructionSet::avx2:
        return front_kernels_avx2<Number>();
#endif
      default:
        return front_kernels_baseline<Number>();
      }
    }
  } // namespace

  template <typename Number>
  const FrontKernels<Number> &
  front_kernels()
  {
    static const FrontKernels<Number> kernels = choose_kernels<Number>();
    return kernels;
  }

  template const FrontKernels<float> &
  front_kernels();
  template const FrontKernels<double> &
  front_kernels();
} // namespace Exemplar
