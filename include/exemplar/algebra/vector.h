// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_vector_h
#define exemplar_vector_h

#include <deal.II/lac/vector.h>

namespace Exemplar
{
  /// A number for each degree of freedom, 3 i + c for component c of node i, or one for each
  /// node.
  using Vector = dealii::Vector<double>;
} // namespace Exemplar

#endif
