// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/body/length_filter.h>
#include <exemplar/body/regions.h>

#include <fmt/core.h>

#include <algorithm>
#include <set>

namespace Exemplar
{
  namespace
  {
    constexpr double negligible_share = 1e-4;

    /// The shares in each cell of a region's material, spread over the length.
    RegionShares
    blended(const std::vector<unsigned int> &ids,
            const std::vector<unsigned int> &region_of_cell,
            const FESpace                   &linear,
            const double                     length,
            const unsigned int               points_per_cell)
    {
      const LengthFilter  filter(linear, length);
      const std::size_t   n = linear.n_nodes();
      std::vector<double> columns(n * ids.size());
      for (unsigned int cell = 0; cell < linear.n_cells(); ++cell)
        filter.add(cell, 1., &columns[region_of_cell[cell] * n]);
      filter.solve(columns);

      std::vector<std::size_t> start = { 0 };
      std::vector<RegionShare> shares;
      for (unsigned int cell = 0; cell < linear.n_cells(); ++cell)
      {
        std::vector<double> value(ids.size());
        double              sum = 0.;
        for (unsigned int region = 0; region < ids.size(); ++region)
        {
          value[region] = filter.mean(cell, &columns[region * n]);
          // obtuse cells can push a share a little below zero; far regions do not matter
          if (region != region_of_cell[cell] && value[region] < negligible_share)
            value[region] = 0.;
          sum += value[region];
        }
        for (unsigned int region = 0; region < ids.size(); ++region)
          if (value[region] > 0.)
            shares.push_back({ region, value[region] / sum });
        start.push_back(shares.size());
      }
      return { ids, start, shares, points_per_cell };
    }
  } // namespace

  RegionShares
  regions_of_materials(const Mesh        &mesh,
                       const double       blend_length,
                       const unsigned int points_per_cell)
  {
    const std::set<unsigned int>   &regions = mesh.whole().material_ids;
    const std::vector<unsigned int> ids(regions.begin(), regions.end());
    std::vector<unsigned int>       region_of_cell;
    std::vector<std::size_t>        start = { 0 };
    std::vector<RegionShare>        shares;
    for (const unsigned int id : mesh.get_material_ids())
    {
      region_of_cell.push_back(
          static_cast<unsigned int>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin()));
      shares.push_back({ region_of_cell.back(), 1. });
      start.push_back(shares.size());
    }
    if (blend_length > 0. && ids.size() > 1)
      return blended(ids, region_of_cell, FESpace(mesh), blend_length, points_per_cell);
    return { ids, start, shares, points_per_cell };
  }

  RegionShares
  painted_regions(const std::vector<std::vector<double>> &painted,
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
    std::vector<unsigned int> ids;
    for (std::size_t id = exchange.any(has_rest) ? 0 : 1; id <= n; ++id)
      ids.push_back(static_cast<unsigned int>(id));
    std::vector<std::size_t> start = { 0 };
    std::vector<RegionShare> shares;
    std::vector<bool>        acts(ids.size(), false);
    for (const std::vector<double> &of_cell : shares_of_cell)
    {
      for (unsigned int region = 0; region < ids.size(); ++region)
        if (const double share = of_cell[ids[region]]; share > 0.)
        {
          shares.push_back({ region, share });
          acts[region] = true;
        }
      start.push_back(shares.size());
    }
    for (unsigned int region = 0; region < ids.size(); ++region)
      if (!exchange.any(acts[region]))
        throw UserError(
            fmt::format("Examples/Weight maps: map {} is 0 in all cells, so its weights would act "
                        "nowhere. Paint it, or remove it from the list.",
                        ids[region]));
    return { ids, start, shares, points_per_cell };
  }

  RegionShares::RegionShares(std::vector<unsigned int>       ids,
                             const std::vector<std::size_t> &start_of_lists,
                             const std::vector<RegionShare> &lists,
                             const unsigned int              n)
      : ids(std::move(ids)), start{ 0 }
  {
    for (std::size_t list = 0; list + 1 < start_of_lists.size(); ++list)
      for (unsigned int point = 0; point < n; ++point)
      {
        shares.insert(shares.end(),
                      lists.begin() + static_cast<std::ptrdiff_t>(start_of_lists[list]),
                      lists.begin() + static_cast<std::ptrdiff_t>(start_of_lists[list + 1]));
        start.push_back(shares.size());
      }
  }
} // namespace Exemplar
