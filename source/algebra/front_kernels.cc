// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/front_kernels.h>
#include <exemplar/base/instruction_set.h>

namespace Exemplar
{
  template <typename Number>
  FrontKernels<Number>
  front_kernels_baseline();
#ifdef __x86_64__
  template <typename Number>
  FrontKernels<Number>
  front_kernels_avx2();
  template <typename Number>
  FrontKernels<Number>
  front_kernels_avx512();
#endif

  namespace
  {
    template <typename Number>
    FrontKernels<Number>
    choose_kernels()
    {
      switch (best_instruction_set())
      {
#ifdef __x86_64__
      case InstructionSet::avx512:
        return front_kernels_avx512<Number>();
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
