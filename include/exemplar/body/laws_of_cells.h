// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_laws_of_cells_h
#define exemplar_laws_of_cells_h

#include <exemplar/kernels/cell_model.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// The law of each cell of a body.
  class LawsOfCells
  {
  public:
    /// One law for all cells.
    LawsOfCells(const CellLaw law) : laws{ law } {}

    /// A law for each cell, of at least one cell.
    explicit LawsOfCells(std::vector<CellLaw> of_cells)
        : laws(of_cells), law_of_cell(std::move(of_cells))
    {
      std::sort(laws.begin(), laws.end());
      laws.erase(std::unique(laws.begin(), laws.end()), laws.end());
    }

    /// Record a law of cells on other processes.
    void
    add(const CellLaw law)
    {
      if (std::find(laws.begin(), laws.end(), law) == laws.end())
        laws.insert(std::upper_bound(laws.begin(), laws.end(), law), law);
    }

    CellLaw
    operator[](const unsigned int cell) const
    {
      return law_of_cell.empty() ? laws.front() : law_of_cell[cell];
    }

    /// The laws that occur on any process, ascending and unique.
    const std::vector<CellLaw> &
    present() const
    {
      return laws;
    }

  private:
    std::vector<CellLaw> laws;
    std::vector<CellLaw> law_of_cell; ///< empty: one law for all
  };
} // namespace Exemplar

#endif
