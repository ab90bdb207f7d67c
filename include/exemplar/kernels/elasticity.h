// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_elasticity_h
#define exemplar_elasticity_h

namespace Exemplar
{
  /// Lamé's constants of an isotropic material [Pa]: C:E = lambda tr(E) I + 2 mu E.
  /// Plain, because the cell kernels see nothing else of a material.
  template <typename Number>
  struct CellMaterial
  {
    Number lambda;
    Number mu;
  };
} // namespace Exemplar

#endif
