// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/single_precision_factor.h>
#include <exemplar/base/instruction_set.h>

#include <algorithm>

namespace Exemplar
{
  TriangularKernels
  triangular_kernels_baseline();
#ifdef __x86_64__
  TriangularKernels
  triangular_kernels_avx2();
  TriangularKernels
  triangular_kernels_avx512();
#endif

  namespace
  {
    TriangularKernels
    choose_kernels()
    {
      switch (best_instruction_set())
      {
#ifdef __x86_64__
      case InstructionSet::avx512:
        return triangular_kernels_avx512();
      case InstructionSet::avx2:
        return triangular_kernels_avx2();
#endif
      default:
        return triangular_kernels_baseline();
      }
    }
  } // namespace

  SinglePrecisionFactor::SinglePrecisionFactor(FactorPanels new_panels)
      : panels(std::move(new_panels)), permuted(panels.permutation.size())
  {
    std::size_t maximum = 0;
    for (std::size_t s = 0; s + 1 < panels.first_row.size(); ++s)
      maximum = std::max(maximum, panels.first_row[s + 1] - panels.first_row[s]);
    block.resize(maximum + FactorPanels::max_lanes);
    panels.values.resize(panels.values.size() + FactorPanels::max_lanes, 0.f);
  }

  void
  SinglePrecisionFactor::solve(std::vector<float> &vector)
  {
    static const TriangularKernels kernels = choose_kernels();
    for (std::size_t i = 0; i < permuted.size(); ++i)
      permuted[i] = vector[panels.permutation[i]];
    kernels.forward(panels, permuted.data(), block.data());
    kernels.backward(panels, permuted.data(), block.data());
    for (std::size_t i = 0; i < permuted.size(); ++i)
      vector[panels.permutation[i]] = permuted[i];
  }

  std::size_t
  SinglePrecisionFactor::memory_consumption() const
  {
    return sizeof(int)
               * (panels.permutation.capacity() + panels.first_column.capacity()
                  + panels.rows.capacity())
           + sizeof(std::size_t) * (panels.first_row.capacity() + panels.first_value.capacity())
           + sizeof(float) * (panels.values.capacity() + permuted.capacity() + block.capacity());
  }
} // namespace Exemplar
