// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_compared_kernels_h
#define exemplar_tests_compared_kernels_h

#include <exemplar/kernels/cell_kernels.h>

#include <vector>

namespace Exemplar::Testing
{
  /// All that this CPU can run, after those for one cell at a time.
  inline std::vector<const CellKernels *>
  scalar_and_all_kernels(const Element element)
  {
    std::vector<const CellKernels *> all = all_kernels(element);
    with_element(element,
                 [&all](const auto of)
                 {
                   static const CellKernels scalar = cell_kernels<Instructions::scalar>(of);
                   all.insert(all.begin(), &scalar);
                 });
    return all;
  }
} // namespace Exemplar::Testing

#endif
