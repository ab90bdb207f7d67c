// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_padded_nodes_h
#define exemplar_padded_nodes_h

#include <exemplar/algebra/vector.h>

#include <deal.II/base/aligned_vector.h>

namespace Exemplar
{
  /// Write a field by degree of freedom as loops read it, with four numbers a node, of which the last stays as it is.
  /// `padded` has its size.
  inline void
  pad_nodes(const Vector &field, dealii::AlignedVector<double> &padded)
  {
    for (std::size_t node = 0; node < padded.size() / 4; ++node)
      for (unsigned int c = 0; c < 3; ++c)
        padded[4 * node + c] = field[3 * node + c];
  }
} // namespace Exemplar

#endif
