// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/length_filter.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// Matrix of the filter: lumped mass plus l^2 times the stiffness of Laplace's equation.
    void
    assemble_filter(const FESpace          &fe_space,
                    const double            l_square,
                    SpdOperator            &filter,
                    const SymmetricPattern &pattern)
    {
      std::vector<double> &values = filter.values();
      std::fill(values.begin(), values.end(), 0.);
      for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      {
        const auto g = fe_space.gradients(cell);
        for (unsigned int a = 0; a < 4; ++a)
          for (unsigned int b = 0; b < 4; ++b)
          {
            const auto row    = static_cast<int>(fe_space.nodes(cell)[a]);
            const auto column = static_cast<int>(fe_space.nodes(cell)[b]);
            if (row >= column)
              values[pattern.position(row, column)]
                  += fe_space.volume(cell) * (l_square * dot(g[a], g[b]) + (a == b ? 0.25 : 0.));
          }
      }
    }
  } // namespace

  LengthFilter::LengthFilter(const FESpace &linear, const double length)
      : linear(linear), matrix(make_cholesky_operator())
  {
    const SymmetricPattern pattern = linear.lower_nodal_pattern();
    matrix->reinit(pattern);
    assemble_filter(linear, length * length / 12., *matrix, pattern);
    matrix->factorize(linear.rest_positions());
  }

  void
  LengthFilter::solve(std::vector<double> &loads) const
  {
    matrix->solve(loads);
  }
} // namespace Exemplar
