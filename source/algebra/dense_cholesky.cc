// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/dense_cholesky.h>

#include <cmath>

namespace Exemplar
{
  bool
  solve_by_cholesky(dealii::FullMatrix<double> &A, std::vector<double> &b)
  {
    const unsigned int n = b.size();
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j <= i; ++j)
      {
        const double before = A(i, j);
        double       value  = before;
        for (unsigned int m = 0; m < j; ++m)
          value -= A(i, m) * A(j, m);
        if (i != j)
          A(i, j) = value / A(j, j);
        else if (value > 1e-14 * std::abs(before) && value > 0.)
          A(i, i) = std::sqrt(value);
        else
          return false;
      }
    for (unsigned int i = 0; i < n; ++i)
    {
      for (unsigned int m = 0; m < i; ++m)
        b[i] -= A(i, m) * b[m];
      b[i] /= A(i, i);
    }
    for (unsigned int i = n; i-- > 0;)
    {
      for (unsigned int m = i + 1; m < n; ++m)
        b[i] -= A(m, i) * b[m];
      b[i] /= A(i, i);
    }
    return true;
  }
} // namespace Exemplar
