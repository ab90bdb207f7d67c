// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_row_matrix_h
#define exemplar_row_matrix_h

#include <exemplar/algebra/spd_operator.h>

#include <vector>

namespace Exemplar
{
  class Problem;

  /// A sparse matrix by rows, columns ascending, of n degrees of freedom, held ones included.
  struct RowMatrix
  {
    std::vector<int>    row_start; ///< size n + 1
    std::vector<int>    column;
    std::vector<double> value;
  };

  /// Expands symmetric matrices from the lower triangle in a SymmetricPattern to full rows. The
  /// columns are found once for each version of the pattern.
  class SymmetricRows
  {
  public:
    /// The rows; `values` are those of the lower triangle, in the order of the pattern.
    RowMatrix
    with(const SymmetricPattern &lower, const std::vector<double> &values);

  private:
    void
    follow(const SymmetricPattern &lower);

    RowMatrix        pattern; ///< of this version; values unset
    unsigned int     version = 0;
    std::vector<int> source; ///< index in the triangle of each value of the rows
  };

  /// The mass matrix [kg] of a problem, as the scene defines it, also for static scenes.
  RowMatrix
  mass_matrix(const Problem &problem);
} // namespace Exemplar

#endif
