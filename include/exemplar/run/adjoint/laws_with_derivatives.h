// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_laws_with_derivatives_h
#define exemplar_laws_with_derivatives_h

#include <exemplar/kernels/cell_model.h>
#include <exemplar/kernels/dual.h>

// The laws of kernels/cell_model.h, whose templates take SIMD registers there and numbers with
// derivatives here.

namespace Exemplar
{
  inline bool
  law_has_potential(const CellLaw law)
  {
    return with_cell_model<double>(law, [](auto model)
                                   { return has_potential<typename decltype(model)::type>; });
  }

  /// Call function(model) with the CellModel of a law that has_potential().
  template <typename Number, typename Function>
  void
  with_potential(const CellLaw law, const Function &function)
  {
    with_cell_model<Number>(law,
                            [&function](auto model)
                            {
                              if constexpr (has_potential<typename decltype(model)::type>)
                                function(model);
                            });
  }
} // namespace Exemplar

#endif
