// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_region_shares_h
#define exemplar_region_shares_h

#include <exemplar/body/fe_space.h>
#include <exemplar/kernels/cell_kernels.h>

#include <vector>

namespace Exemplar
{
  /// How much of each region's example weights acts in each cell: shares in [0, 1] that
  /// sum to one. Regions are the cells of one material id, or what is painted.
  class RegionShares
  {
  public:
    /// Without a blend length [m] a cell belongs to its own region alone. With one, the
    /// shares change smoothly over about this distance, measured inside the body: they
    /// solve s - l^2 Laplace s = indicator of the region, with natural boundary and
    /// l = blend_length / (2 sqrt 3), the filter of Lazarov and Sigmund 2011.
    RegionShares(const FESpace                   &fe_space,
                 const std::vector<unsigned int> &material_ids,
                 double                           blend_length);

    /// Regions that are painted: for each of them, from number 1 on, its map's value in every
    /// cell. Where values sum to more than one they are divided by their sum; where they sum to
    /// less, the rest is of a region 0, which is not there if nothing is left anywhere. Throws
    /// UserError for a map that is zero everywhere.
    explicit RegionShares(const std::vector<std::vector<double>> &painted);

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

    /// The regions that act in a cell, in the range first to last - 1 of list().
    std::size_t
    first(const unsigned int cell) const
    {
      return start[cell];
    }

    std::size_t
    last(const unsigned int cell) const
    {
      return start[cell + 1];
    }

    /// The shares of all cells, one cell after the other.
    const std::vector<RegionShare> &
    list() const
    {
      return shares;
    }

    /// Where each cell's shares begin in list(), and its end.
    const std::vector<std::size_t> &
    starts() const
    {
      return start;
    }

  private:
    void
    blend(const FESpace &fe_space, double length);

    std::vector<unsigned int> ids;
    std::vector<std::size_t>  start;
    std::vector<RegionShare>  shares;
  };
} // namespace Exemplar

#endif
