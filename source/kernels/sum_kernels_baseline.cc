// SPDX-License-Identifier: GPL-3.0-or-later
// The loops over cells of laws that are sums of others for the instruction set that every CPU of the kind has, one
// by one and as many at once as its registers hold.
#include <exemplar/kernels/cell_kernels_loops.h>

#include <xsimd/xsimd.hpp>

namespace Exemplar
{
  template <>
  LawKernels
  sum_kernels_scalar(const ElementConstant<Element::P1> element)
  {
    return Loops::make_law_kernels<SumsOfLaws, double>(element);
  }

  template <>
  LawKernels
  sum_kernels_scalar(const ElementConstant<Element::P2> element)
  {
    return Loops::make_law_kernels<SumsOfLaws, double>(element);
  }

  template <>
  LawKernels
  sum_kernels_baseline(const ElementConstant<Element::P1> element)
  {
    return Loops::make_law_kernels<SumsOfLaws, xsimd::batch<double, xsimd::default_arch>>(element);
  }

  template <>
  LawKernels
  sum_kernels_baseline(const ElementConstant<Element::P2> element)
  {
    return Loops::make_law_kernels<SumsOfLaws, xsimd::batch<double, xsimd::default_arch>>(element);
  }
} // namespace Exemplar
