// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_region_shares_h
#define exemplar_region_shares_h

#include <exemplar/body/fe_space.h>
#include <exemplar/kernels/cell_kernels.h>

#include <set>
#include <vector>

namespace Exemplar
{
  /// How much of each region's example weights acts in each cell: shares in [0, 1] that sum to one,
  /// the same at all quadrature points of a cell. Regions are the cells of one material id, or what
  /// is painted.
  class RegionShares
  {
  public:
    /// Without a blend length [m] a cell belongs to its own region alone. With one, the
    /// shares change smoothly over about this distance, measured inside the body: they
    /// solve s - l^2 Laplace s = indicator of the region, with natural boundary and
    /// l = blend_length / (2 sqrt 3), the filter of Lazarov and Sigmund 2011, on linear elements; this
    /// one process must do. `regions` are the material ids of the whole body.
    RegionShares(const FESpace                   &linear,
                 const std::vector<unsigned int> &material_ids,
                 const std::set<unsigned int>    &regions,
                 double                           blend_length,
                 unsigned int                     points_per_cell = 1);

    /// Regions that are painted: for each of them, from number 1 on, its map's value in every
    /// cell. Where values sum to more than one they are divided by their sum; where they sum to
    /// less, the rest is of a region 0, which is not there if nothing is left anywhere. Throws
    /// UserError for a map that is zero everywhere.
    explicit RegionShares(const std::vector<std::vector<double>> &painted,
                          unsigned int                            points_per_cell = 1);

    unsigned int
    n_regions() const
    {
      return ids.size();
    }

    /// Or the number of a painted region.
    unsigned int
    material_id(const unsigned int region) const
    {
      return ids[region];
    }

    /// The regions that act at a point, in the range first to last - 1 of list().
    std::size_t
    first(const unsigned int point) const
    {
      return start[point];
    }

    std::size_t
    last(const unsigned int point) const
    {
      return start[point + 1];
    }

    /// The shares of all points, one point after the other.
    const std::vector<RegionShare> &
    list() const
    {
      return shares;
    }

    /// Where each point's shares begin in list(), and its end.
    const std::vector<std::size_t> &
    starts() const
    {
      return start;
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
