// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/spd_operator.h>
#include <exemplar/base/errors.h>
#include <exemplar/body/region_shares.h>

#include <fmt/core.h>

#include <algorithm>
#include <set>

namespace Exemplar
{
  namespace
  {
    constexpr double negligible_share = 1e-4;

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

  RegionShares::RegionShares(const Mesh        &mesh,
                             const double       blend_length,
                             const unsigned int points_per_cell)
  {
    const std::set<unsigned int> &regions = mesh.whole().material_ids;
    ids.assign(regions.begin(), regions.end());
    for (const unsigned int id : mesh.get_material_ids())
    {
      const auto own = std::lower_bound(ids.begin(), ids.end(), id);
      start.push_back(shares.size());
      shares.push_back({ static_cast<unsigned int>(own - ids.begin()), 1. });
    }
    start.push_back(shares.size());
    if (blend_length > 0. && n_regions() > 1)
      blend(FESpace(mesh), blend_length);
    spread(points_per_cell);
  }

  RegionShares::RegionShares(const std::vector<std::vector<double>> &painted,
                             const unsigned int                      points_per_cell,
                             const Exchange                         &exchange)
  {
    const std::size_t                n = painted.size();
    std::vector<std::vector<double>> shares_of_cell(painted.front().size());
    bool                             has_rest = false;
    for (std::size_t cell = 0; cell < shares_of_cell.size(); ++cell)
    {
      std::vector<double> &of_cell = shares_of_cell[cell];
      double               sum     = 0.;
      of_cell.push_back(0.);
      for (const std::vector<double> &map : painted)
      {
        of_cell.push_back(map[cell] < negligible_share ? 0. : map[cell]);
        sum += of_cell.back();
      }
      of_cell[0] = 1. - sum < negligible_share ? 0. : 1. - sum;
      has_rest   = has_rest || of_cell[0] > 0.;
      for (double &share : of_cell)
        share /= of_cell[0] + sum;
    }
    for (std::size_t id = exchange.any(has_rest) ? 0 : 1; id <= n; ++id)
      ids.push_back(static_cast<unsigned int>(id));
    std::vector<bool> acts(n_regions(), false);
    for (const std::vector<double> &of_cell : shares_of_cell)
    {
      start.push_back(shares.size());
      for (unsigned int region = 0; region < n_regions(); ++region)
        if (const double share = of_cell[ids[region]]; share > 0.)
        {
          shares.push_back({ region, share });
          acts[region] = true;
        }
    }
    start.push_back(shares.size());
    for (unsigned int region = 0; region < n_regions(); ++region)
      if (!exchange.any(acts[region]))
        throw UserError(
            fmt::format("Examples/Weight maps: map {} is 0 in all cells, so its weights would act "
                        "nowhere. Paint it, or remove it from the list.",
                        ids[region]));
    spread(points_per_cell);
  }

  void
  RegionShares::spread(const unsigned int points_per_cell)
  {
    if (points_per_cell == 1)
      return;
    const std::vector<RegionShare> of_cells = std::move(shares);
    const std::vector<std::size_t> of_cell  = std::move(start);
    shares.clear();
    start = { 0 };
    for (std::size_t cell = 0; cell + 1 < of_cell.size(); ++cell)
      for (unsigned int point = 0; point < points_per_cell; ++point)
      {
        shares.insert(shares.end(), of_cells.begin() + static_cast<std::ptrdiff_t>(of_cell[cell]),
                      of_cells.begin() + static_cast<std::ptrdiff_t>(of_cell[cell + 1]));
        start.push_back(shares.size());
      }
  }

  void
  RegionShares::blend(const FESpace &linear, const double length)
  {
    const SymmetricPattern pattern = lower_pattern(linear.nodal_pattern());
    const auto             filter  = make_cholesky_operator();
    filter->reinit(pattern);
    assemble_filter(linear, length * length / 12., *filter, pattern);
    filter->factorize(linear.rest_positions());

    const std::size_t   n = linear.n_nodes();
    std::vector<double> columns(n * n_regions());
    for (unsigned int cell = 0; cell < linear.n_cells(); ++cell)
      for (const unsigned int node : linear.nodes(cell))
        columns[shares[cell].region * n + node] += 0.25 * linear.volume(cell);
    filter->solve(columns);

    const std::vector<RegionShare> own_shares = std::move(shares);
    shares.clear();
    start.clear();
    for (unsigned int cell = 0; cell < linear.n_cells(); ++cell)
    {
      const unsigned int  own = own_shares[cell].region;
      std::vector<double> value(n_regions());
      double              sum = 0.;
      for (unsigned int region = 0; region < n_regions(); ++region)
      {
        for (const unsigned int node : linear.nodes(cell))
          value[region] += 0.25 * columns[region * n + node];
        // obtuse cells can push a share a little below zero; far regions do not matter
        if (region != own && value[region] < negligible_share)
          value[region] = 0.;
        sum += value[region];
      }
      start.push_back(shares.size());
      for (unsigned int region = 0; region < n_regions(); ++region)
        if (value[region] > 0.)
          shares.push_back({ region, value[region] / sum });
    }
    start.push_back(shares.size());
  }
} // namespace Exemplar
