// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/obstacles/box_grid.h>

#include <cmath>

namespace Exemplar
{
  namespace
  {
    constexpr double       cells_of_a_box = 20.;     ///< on average, at most
    constexpr std::int64_t most_cells     = 1 << 20; ///< along an axis
  }                                                  // namespace

  BoxGrid::BoxGrid(std::vector<AxisBox> all) : boxes(std::move(all))
  {
    if (boxes.empty())
      return;
    double sum = 0.;
    for (const AxisBox &box : boxes)
    {
      around.add(box);
      const dealii::Tensor<1, 3> extent = box.high - box.low;
      sum += std::max({ extent[0], extent[1], extent[2] });
    }
    const dealii::Tensor<1, 3> extent  = around.high - around.low;
    const double               longest = std::max({ extent[0], extent[1], extent[2] });
    size                               = std::max(
                                      { sum / boxes.size(), longest / most_cells, std::numeric_limits<double>::min() });
    const auto count_cells = [&]
    {
      for (unsigned int c = 0; c < 3; ++c)
        most[c] = static_cast<std::int64_t>(std::floor(extent[c] / size));
    };
    count_cells();
    // large boxes among many small ones would be in too many cells
    while (n_cells_of_boxes() > cells_of_a_box * boxes.size())
    {
      size *= 2.;
      count_cells();
    }
    for (unsigned int i = 0; i < boxes.size(); ++i)
      visit_cells(cell_of(boxes[i].low), cell_of(boxes[i].high),
                  [&](const Cell &cell) { entries.emplace_back(key_of(cell), i); });
    std::sort(entries.begin(), entries.end());
  }

  BoxGrid::Cell
  BoxGrid::cell_of(const dealii::Tensor<1, 3> &place) const
  {
    Cell cell;
    for (unsigned int c = 0; c < 3; ++c)
      cell[c] = static_cast<std::int64_t>(std::clamp(std::floor((place[c] - around.low[c]) / size),
                                                     0., static_cast<double>(most[c])));
    return cell;
  }

  double
  BoxGrid::n_cells_of_boxes() const
  {
    double sum = 0.;
    for (const AxisBox &box : boxes)
    {
      const Cell low = cell_of(box.low), high = cell_of(box.high);
      double     n = 1.;
      for (unsigned int c = 0; c < 3; ++c)
        n *= static_cast<double>(high[c] - low[c] + 1);
      sum += n;
    }
    return sum;
  }
} // namespace Exemplar
