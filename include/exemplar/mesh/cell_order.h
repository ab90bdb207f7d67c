// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_order_h
#define exemplar_cell_order_h

#include <exemplar/algebra/exchange.h>

#include <vector>

namespace Exemplar
{
  /// Which cells of a body a process has, and what makes numbers of cells those of the whole body.
  class CellOrder
  {
  public:
    /// `in_file` are the places of this process' cells among the `n_cells` of the body, ascending.
    /// `exchange` must outlive this.
    CellOrder(std::vector<unsigned int> in_file, unsigned int n_cells, const Exchange &exchange);

    /// In the order of the file.
    const std::vector<unsigned int> &
    in_file() const
    {
      return places;
    }

    /// Of values of the cells, equally many each: those of the whole body in the order of its file, the
    /// same in all processes, which must all call this.
    std::vector<double>
    whole(const std::vector<double> &own) const;

    /// What of a whole() this process has.
    std::vector<double>
    part(const std::vector<double> &of_whole_body) const;

  private:
    std::vector<unsigned int> places;
    unsigned int              n_of_whole;
    const Exchange           *exchange;
  };
} // namespace Exemplar

#endif
