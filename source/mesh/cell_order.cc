// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/cell_order.h>

#include <algorithm>
#include <utility>

namespace Exemplar
{
  CellOrder::CellOrder(std::vector<unsigned int> in_file,
                       const unsigned int        n_cells,
                       const Exchange           &exchange)
      : places(std::move(in_file)), n_of_whole(n_cells), exchange(&exchange)
  {
  }

  std::vector<double>
  CellOrder::whole(const std::vector<double> &own) const
  {
    const std::size_t   n = own.size() / places.size(); // values of each cell
    std::vector<double> all(n * n_of_whole, 0.);
    for (std::size_t cell = 0; cell < places.size(); ++cell)
      std::copy_n(own.begin() + n * cell, n, all.begin() + n * places[cell]);
    exchange->sum(all);
    return all;
  }

  std::vector<double>
  CellOrder::part(const std::vector<double> &of_whole_body) const
  {
    const std::size_t   n = of_whole_body.size() / n_of_whole; // values of each cell
    std::vector<double> own(n * places.size());
    for (std::size_t cell = 0; cell < places.size(); ++cell)
      std::copy_n(of_whole_body.begin() + n * places[cell], n, own.begin() + n * cell);
    return own;
  }
} // namespace Exemplar
