// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/length_filter.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// Lower triangle of a nodal matrix.
    SymmetricPattern
    lower_pattern(const dealii::SparsityPattern &nodal)
    {
      SymmetricPattern pattern;
      pattern.column_start.push_back(0);
      for (unsigned int node = 0; node < nodal.n_rows(); ++node)
      {
        const auto begin = pattern.row.size();
        for (auto entry = nodal.begin(node); entry != nodal.end(node); ++entry)
          if (entry->column() >= node)
            pattern.row.push_back(static_cast<int>(entry->column()));
        std::sort(pattern.row.begin() + static_cast<std::ptrdiff_t>(begin), pattern.row.end());
        pattern.column_start.push_back(static_cast<int>(pattern.row.size()));
      }
      return pattern;
    }

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
    const SymmetricPattern pattern = lower_pattern(linear.nodal_pattern());
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
