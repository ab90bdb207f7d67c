// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_region_shares_h
#define exemplar_region_shares_h

#include <exemplar/body/fe_space.h>
#include <exemplar/kernels/cell_kernels.h>

#include <optional>
#include <vector>

namespace Exemplar
{
  /// The shares of regions in each cell, by which their example weights act: in [0, 1], with sum
  /// one, the same at all quadrature points of a cell. Regions are the cells of one material id, or
  /// are painted; or the whole body is the only one, without a list of shares.
  class RegionShares
  {
  public:
    /// One region, the whole body.
    RegionShares() = default;

    /// Regions by material id of the whole mesh. Without a blend length [m] a cell belongs to its
    /// own region alone. With one, shares change smoothly over about this distance, measured inside
    /// the body: they solve s - l^2 Laplace s = indicator of the region, with natural boundary
    /// conditions and l = blend_length / (2 sqrt 3), the filter of Lazarov and Sigmund 2011, on
    /// linear elements; only for a single process.
    RegionShares(const Mesh &mesh, double blend_length, unsigned int points_per_cell = 1);

    /// Painted regions: for each of them, from number 1 on, its map's value in every cell. Where
    /// values sum to more than one they are divided by their sum; where they sum to less, the rest
    /// belongs to region 0, which exists only if there is a rest anywhere. Throws UserError for a
    /// map that is zero everywhere. Collective.
    explicit RegionShares(const std::vector<std::vector<double>> &painted,
                          unsigned int                            points_per_cell = 1,
                          const Exchange                         &exchange = Exchange::serial());

    unsigned int
    n_regions() const
    {
      return ids.empty() ? 1 : ids.size();
    }

    /// Material id or number of a painted region; none for the whole body.
    std::optional<unsigned int>
    material_id(const unsigned int region) const
    {
      return ids.empty() ? std::optional<unsigned int>() : ids[region];
    }

    /// Call function(region, share) for the regions that act at a point.
    template <typename Function>
    void
    for_each(const unsigned int point, const Function &function) const
    {
      if (ids.empty())
        function(0, 1.);
      else
        for (std::size_t s = start[point]; s < start[point + 1]; ++s)
          function(shares[s].region, shares[s].value);
    }

    /// Share of a region at a point, in [0, 1].
    double
    share(const unsigned int point, const unsigned int region) const
    {
      double found = 0.;
      for_each(point, [&](const unsigned int acting, const double value)
               { found = acting == region ? value : found; });
      return found;
    }

    /// The shares of all points, one point after the other; null: the whole body.
    const RegionShare *
    list() const
    {
      return shares.empty() ? nullptr : shares.data();
    }

    /// Begin of each point's shares in list(), and the end; null: the whole body.
    const std::size_t *
    starts() const
    {
      return start.empty() ? nullptr : start.data();
    }

  private:
    void
    blend(const FESpace &linear, double length);

    /// Give each point the shares of its cell.
    void
    spread(unsigned int points_per_cell);

    std::vector<unsigned int> ids;
    std::vector<std::size_t>  start;
    std::vector<RegionShare>  shares;
  };
} // namespace Exemplar

#endif
