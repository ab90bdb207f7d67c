// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_box_grid_h
#define exemplar_box_grid_h

#include <exemplar/obstacles/box_tree.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// Finds which of many boxes meet another one, by a grid of which the occupied cells are sorted: faster to make than a
  /// BoxTree, where boxes are of about one size.
  class BoxGrid
  {
  public:
    explicit BoxGrid(std::vector<AxisBox> boxes);

    /// Call visit(i) once for each box i that meets `box`, in an order that the boxes decide.
    template <typename Visit>
    void
    visit(const AxisBox &box, const Visit &visit) const;

  private:
    using Cell = std::array<std::int64_t, 3>;
    using Key  = std::uint64_t;

    /// The cell of a place, that at the rim if it is outside.
    Cell
    cell_of(const dealii::Tensor<1, 3> &place) const;

    static Key
    key_of(const Cell &cell)
    {
      Key key = 0;
      for (const std::int64_t i : cell)
        key = key << 21U | static_cast<Key>(i);
      return key;
    }

    /// Call visit(cell) for the cells from one to another.
    template <typename Visit>
    static void
    visit_cells(const Cell &low, const Cell &high, const Visit &visit)
    {
      Cell cell;
      for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0])
        for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1])
          for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2])
            visit(cell);
    }

    /// How many cells the boxes are in, all together.
    double
    n_cells_of_boxes() const;

    std::vector<AxisBox>                      boxes;
    AxisBox                                   around;
    double                                    size = 1.; ///< of a cell [m]
    Cell                                      most{};    ///< the last cell
    std::vector<std::pair<Key, unsigned int>> entries;   ///< cells and boxes, ascending
  };

  template <typename Visit>
  void
  BoxGrid::visit(const AxisBox &box, const Visit &visit) const
  {
    if (boxes.empty() || !box.meets(around))
      return;
    const Cell low = cell_of(box.low);
    visit_cells(low, cell_of(box.high),
                [&](const Cell &cell)
                {
                  const Key key = key_of(cell);
                  auto entry = std::lower_bound(entries.begin(), entries.end(), std::pair(key, 0U));
                  for (; entry != entries.end() && entry->first == key; ++entry)
                  {
                    const AxisBox &other = boxes[entry->second];
                    if (!box.meets(other))
                      continue;
                    // both are in more cells: the first that they have in common counts
                    const Cell other_low = cell_of(other.low);
                    bool       is_first  = true;
                    for (unsigned int c = 0; c < 3; ++c)
                      is_first = is_first && cell[c] == std::max(low[c], other_low[c]);
                    if (is_first)
                      visit(entry->second);
                  }
                });
  }
} // namespace Exemplar

#endif
