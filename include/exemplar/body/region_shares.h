// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_region_shares_h
#define exemplar_region_shares_h

#include <exemplar/kernels/example_arrays.h>

#include <optional>
#include <vector>

namespace Exemplar
{
  /// The shares of regions at each point of a body, by which their example weights act: in [0, 1], with
  /// sum one. Regions have a number; or the whole body is the only one, without a list of shares.
  class RegionShares
  {
  public:
    /// One region, the whole body.
    RegionShares() = default;

    /// The regions `ids`, and lists of shares one after the other, of which the i-th begins at start[i] and
    /// is that of `n` consecutive points.
    RegionShares(std::vector<unsigned int>       ids,
                 const std::vector<std::size_t> &start,
                 const std::vector<RegionShare> &shares,
                 unsigned int                    n = 1);

    unsigned int
    n_regions() const
    {
      return ids.empty() ? 1 : ids.size();
    }

    /// Number of a region, which is its material id or that of its map; none for the whole body.
    std::optional<unsigned int>
    id(const unsigned int region) const
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
    std::vector<unsigned int> ids;
    std::vector<std::size_t>  start;
    std::vector<RegionShare>  shares;
  };
} // namespace Exemplar

#endif
