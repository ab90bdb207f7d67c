// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_row_matrix_h
#define exemplar_row_matrix_h

#include <exemplar/algebra/spd_operator.h>

#include <vector>

namespace Exemplar
{
  class Problem;

  /// A sparse matrix by rows, of columns that ascend: of n degrees of freedom, held ones included.
  struct RowMatrix
  {
    std::vector<int>    row_start; ///< n + 1
    std::vector<int>    column;
    std::vector<double> value;
  };

  /// All rows of symmetric matrices of which a SymmetricPattern has the lower triangle. The columns are
  /// found once for each version of the pattern.
  class SymmetricRows
  {
  public:
    /// `values` are those of the lower triangle, in the order of the pattern.
    RowMatrix
    with(const SymmetricPattern &lower, const std::vector<double> &values);

  private:
    void
    follow(const SymmetricPattern &lower);

    RowMatrix        pattern; ///< of this version, without values
    unsigned int     version = 0;
    std::vector<int> source; ///< of the rows' values among those of the triangle
  };

  /// The mass matrix [kg] of a problem, as its scene has it; in a static scene, too.
  RowMatrix
  mass_matrix(const Problem &problem);
} // namespace Exemplar

#endif
