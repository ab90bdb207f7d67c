// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_symmetric_h
#define exemplar_symmetric_h

#include <exemplar/kernels/matrix3.h>

// Storage of symmetric matrices, the strains of cells: six numbers xx, yy, zz, yz, xz, xy.

namespace Exemplar
{
  constexpr std::size_t n_symmetric = 6;

  /// The six independent entries of a symmetric 3 x 3 matrix.
  template <typename Number>
  struct SymmetricEntries
  {
    Number value[n_symmetric];

    Number &
    operator[](const std::size_t k)
    {
      return value[k];
    }

    const Number &
    operator[](const std::size_t k) const
    {
      return value[k];
    }
  };

  /// The six numbers of a matrix, from its upper triangle.
  template <typename Number>
  SymmetricEntries<Number>
  pack(const Matrix3<Number> &S)
  {
    return { { S[0][0], S[1][1], S[2][2], S[1][2], S[0][2], S[0][1] } };
  }

  template <typename Number>
  Matrix3<Number>
  unpack(const SymmetricEntries<Number> &e)
  {
    return { { { e[0], e[5], e[4] }, { e[5], e[1], e[3] }, { e[4], e[3], e[2] } } };
  }

  /// Add a times the symmetric matrix S to matrix i of the n that `values` stores for each cell, in
  /// batches.
  inline void
  add_to_stored(double                *values,
                const std::size_t      cell,
                const std::size_t      n,
                const std::size_t      i,
                const double           a,
                const Matrix3<double> &S)
  {
    const SymmetricEntries<double> entries = pack(S);
    for (std::size_t k = 0; k < n_symmetric; ++k)
      values[batch_index(cell, n_symmetric * n, n_symmetric * i + k)] += a * entries[k];
  }

  /// Load the matrix that add_to_stored() has summed up.
  inline Matrix3<double>
  load_stored(const double     *values,
              const std::size_t cell,
              const std::size_t n,
              const std::size_t i)
  {
    SymmetricEntries<double> entries;
    for (std::size_t k = 0; k < n_symmetric; ++k)
      entries[k] = values[batch_index(cell, n_symmetric * n, n_symmetric * i + k)];
    return unpack(entries);
  }
} // namespace Exemplar

#endif
