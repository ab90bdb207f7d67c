// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/posing/fold_neighbourhood.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// Stiffness of the springs that hold nodes, over that of the body.
    constexpr double holding = 1e6;
  } // namespace

  std::vector<char>
  grown(const FoldPotential::Cells &cells, std::vector<char> marked, const unsigned int n_rings)
  {
    for (unsigned int ring = 0; ring < n_rings; ++ring)
    {
      const std::vector<char> before = marked;
      for (const auto &cell : cells)
        if (std::any_of(cell.begin(), cell.end(),
                        [&](const unsigned int i) { return before[i] != 0; }))
          for (const unsigned int i : cell)
            marked[i] = 1;
    }
    return marked;
  }

  FoldNeighbourhood::Numbering
  FoldNeighbourhood::number(const FoldPotential::Cells &cells, const std::vector<char> &free)
  {
    Numbering result{ std::vector<int>(free.size(), -1), {}, {} };
    for (const auto &cell : cells)
    {
      if (std::none_of(cell.begin(), cell.end(),
                       [&](const unsigned int i) { return free[i] != 0; }))
        continue;
      std::array<unsigned int, 4> local;
      for (int a = 0; a < 4; ++a)
      {
        int &number = result.number[cell[a]];
        if (number < 0)
        {
          number = static_cast<int>(result.nodes.size());
          result.nodes.push_back(cell[a]);
        }
        local[a] = static_cast<unsigned int>(number);
      }
      result.cells.push_back(local);
    }
    return result;
  }

  FoldNeighbourhood::Points
  FoldNeighbourhood::selected(const Points &points, const std::vector<unsigned int> &which)
  {
    Points result;
    for (const unsigned int i : which)
      result.push_back(points[i]);
    return result;
  }

  FoldNeighbourhood::FoldNeighbourhood(const FoldPotential &whole,
                                       const Points        &rest,
                                       const Points        &x,
                                       std::vector<char>    marked,
                                       const unsigned int   n_rings)
      : free(grown(whole.get_cells(), std::move(marked), n_rings - 1)),
        numbering(number(whole.get_cells(), free)), start(selected(x, numbering.nodes)),
        potential(selected(rest, numbering.nodes), numbering.cells, whole.get_n_threads())
  {
    // energies are means over the neighbourhood
    const double share = whole.get_volume() / potential.get_volume();
    const double held  = holding / std::pow(potential.get_volume(), 2. / 3.);
    for (std::size_t k = 0; k < start.size(); ++k)
    {
      const unsigned int i              = numbering.nodes[k];
      const bool         is_free        = free[i] != 0;
      potential.attachment.stiffness[k] = is_free ? share * whole.attachment.stiffness[i] : held;
      potential.attachment.target[k]    = is_free ? whole.attachment.target[i] : start[k];
    }
  }

  void
  FoldNeighbourhood::copy_back(const Points &of_neighbourhood, Points &x) const
  {
    for (std::size_t k = 0; k < of_neighbourhood.size(); ++k)
      if (free[numbering.nodes[k]] != 0)
        x[numbering.nodes[k]] = of_neighbourhood[k];
  }
} // namespace Exemplar
