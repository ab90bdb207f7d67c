// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_order_h
#define exemplar_cell_order_h

#include <exemplar/algebra/exchange.h>

#include <vector>

namespace Exemplar
{
  /// The cells of a body that a process has, and the exchange of cell data with the whole body.
  class CellOrder
  {
  public:
    /// `in_file` are the indices of this process' cells among the `n_cells` of the body, ascending.
    /// `exchange` must outlive this.
    CellOrder(std::vector<unsigned int> in_file, unsigned int n_cells, const Exchange &exchange);

    /// Indices of this process' cells in the order of the file.
    const std::vector<unsigned int> &
    in_file() const
    {
      return places;
    }

    /// Gather values of the cells, equally many each, for the whole body in the order of its file,
    /// the same on all processes. Collective.
    std::vector<double>
    whole(const std::vector<double> &own) const;

    /// The values of a whole() in this process' cells.
    std::vector<double>
    part(const std::vector<double> &of_whole_body) const;

  private:
    std::vector<unsigned int> places;
    unsigned int              n_of_whole;
    const Exchange           *exchange;
  };
} // namespace Exemplar

#endif
