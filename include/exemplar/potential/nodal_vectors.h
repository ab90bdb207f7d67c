// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_nodal_vectors_h
#define exemplar_nodal_vectors_h

#include <exemplar/algebra/vector.h>

#include <deal.II/base/point.h>

namespace Exemplar
{
  /// The three entries of a node in a field by degree of freedom.
  inline dealii::Tensor<1, 3>
  at_node(const Vector &field, const unsigned int node)
  {
    return dealii::Point<3>(field[3 * node], field[3 * node + 1], field[3 * node + 2]);
  }

  /// Add to them.
  inline void
  add_to(Vector &field, const unsigned int node, const dealii::Tensor<1, 3> &value)
  {
    for (unsigned int c = 0; c < 3; ++c)
      field[3 * node + c] += value[c];
  }
} // namespace Exemplar

#endif
