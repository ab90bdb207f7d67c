// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/conditioning.h>

#include <deal.II/lac/lapack_full_matrix.h>

#include <cmath>
#include <limits>

namespace Exemplar
{
  dealii::FullMatrix<double>
  form_of_differences(const dealii::FullMatrix<double> &form, const unsigned int k)
  {
    const unsigned int         n = form.m() - form.m() / k;
    dealii::FullMatrix<double> differences(n, n);
    const auto                 first  = [k](const unsigned int d) { return d / (k - 1) * k; };
    const auto                 second = [k](const unsigned int d) { return d + d / (k - 1) + 1; };
    for (unsigned int d = 0; d < n; ++d)
      for (unsigned int f = 0; f < n; ++f)
        differences(d, f) = form(second(d), second(f)) - form(second(d), first(f))
                            - form(first(d), second(f)) + form(first(d), first(f));
    return differences;
  }

  double
  condition_number(const dealii::FullMatrix<double> &matrix)
  {
    const unsigned int n = matrix.m();
    if (n == 0)
      return 1.;
    dealii::LAPACKFullMatrix<double> scaled(n, n);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
      {
        if (!(matrix(i, i) > 0.))
          return std::numeric_limits<double>::infinity();
        scaled(i, j) = matrix(i, j) / std::sqrt(matrix(i, i) * matrix(j, j));
      }
    dealii::Vector<double>     values(n);
    dealii::FullMatrix<double> vectors;
    scaled.compute_eigenvalues_symmetric(-1., 2. * n, 0., values, vectors);
    const bool is_definite = values.size() == n && values[0] > 0.;
    return is_definite ? values[n - 1] / values[0] : std::numeric_limits<double>::infinity();
  }
} // namespace Exemplar
