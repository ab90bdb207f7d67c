// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/lanczos.h>

#include <deal.II/lac/tridiagonal_matrix.h>

#include <cmath>
#include <vector>

namespace Exemplar
{
  namespace
  {
    double
    dot(const BlockVector &a,
        const BlockVector &b,
        const std::size_t  n_blocks,
        const Exchange    &exchange)
    {
      double sum = 0.;
      for (std::size_t i = 0; i < n_blocks; ++i)
        for (unsigned int c = 0; c < 3; ++c)
          sum += static_cast<double>(a[4 * i + c]) * b[4 * i + c];
      return exchange.sum(sum);
    }

    /// Lanczos' symmetric tridiagonal matrix: its diagonal and its off-diagonal.
    struct Tridiagonal
    {
      std::vector<double> diagonal, beside;
    };

    /// Conjugate gradients, whose coefficients give Lanczos' tridiagonal matrix.
    Tridiagonal
    iterate(const BlockMatrix &matrix, const Precondition &precondition, const Exchange &exchange)
    {
      Tridiagonal       result;
      const std::size_t n = matrix.n_rows();
      BlockVector       r = matrix.zeros(), p = r, image = r;
      double            old_product = 0., old_length = 0.;
      for (std::size_t i = 0; i < 4 * n; ++i)
        r[i] = std::sin(1.F + 1.7F * static_cast<float>(i % 1000)); // an arbitrary start vector
      for (unsigned int k = 0; k < n_lanczos_steps; ++k)
      {
        const BlockVector &z       = precondition(r);
        const double       product = dot(r, z, n, exchange);
        const double       beta    = k == 0 ? 0. : product / old_product;
        for (std::size_t i = 0; i < 4 * n; ++i)
          p[i] = z[i] + static_cast<float>(beta) * p[i];
        matrix.multiply(p, image);
        const double curvature = dot(p, image, n, exchange);
        if (!(product > 0. && curvature > 0.))
          break;
        const double length = product / curvature;
        for (std::size_t i = 0; i < 4 * n; ++i)
          r[i] -= static_cast<float>(length) * image[i];
        if (k > 0)
          result.beside.push_back(std::sqrt(beta) / old_length);
        result.diagonal.push_back(1. / length + (k == 0 ? 0. : beta / old_length));
        old_product = product;
        old_length  = length;
      }
      return result;
    }
  } // namespace

  std::pair<double, double>
  find_eigenvalues(const BlockMatrix  &matrix,
                   const Precondition &precondition,
                   const Exchange     &exchange)
  {
    const auto [diagonal, beside] = iterate(matrix, precondition, exchange);
    if (diagonal.empty())
      return { 0.5, 1. };
    dealii::TridiagonalMatrix<double> tridiagonal(diagonal.size(), true);
    for (std::size_t i = 0; i < diagonal.size(); ++i)
    {
      tridiagonal(i, i) = diagonal[i];
      if (i + 1 < diagonal.size())
        tridiagonal(i, i + 1) = beside[i];
    }
    tridiagonal.compute_eigenvalues();
    return { tridiagonal.eigenvalue(0), tridiagonal.eigenvalue(diagonal.size() - 1) };
  }
} // namespace Exemplar
