// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_fold_neighbourhood_h
#define exemplar_fold_neighbourhood_h

#include <exemplar/surface/posing/fold_potential.h>

namespace Exemplar
{
  /// The surroundings of some cells of a body as a body of their own, which is small where these
  /// cells are few. What lies around is held where it is.
  class FoldNeighbourhood
  {
  public:
    using Points = FoldPotential::Points;

    /// Around the nodes that are marked, as many rings of cells as `n_rings`, at least one. `rest`
    /// and `x` are the nodes of the whole body at rest and now.
    FoldNeighbourhood(const FoldPotential &whole,
                      const Points        &rest,
                      const Points        &x,
                      std::vector<char>    marked,
                      unsigned int         n_rings);

    FoldPotential &
    get_potential()
    {
      return potential;
    }

    /// Of the nodes of the neighbourhood.
    const Points &
    get_start() const
    {
      return start;
    }

    /// Write places of the neighbourhood's nodes to those of the whole body.
    void
    copy_back(const Points &of_neighbourhood, Points &x) const;

  private:
    /// Number in the neighbourhood of each node of the body, or -1; nodes and cells of the neighbourhood.
    struct Numbering
    {
      std::vector<int>          number;
      std::vector<unsigned int> nodes;
      FoldPotential::Cells      cells;
    };

    static Numbering
    number(const FoldPotential::Cells &cells, const std::vector<char> &free);

    static Points
    selected(const Points &points, const std::vector<unsigned int> &which);

    std::vector<char> free; ///< of the whole body's nodes
    Numbering         numbering;
    Points            start;
    FoldPotential     potential;
  };

  /// Marks the nodes of cells with a marked node, `n_rings` times.
  std::vector<char>
  grown(const FoldPotential::Cells &cells, std::vector<char> marked, unsigned int n_rings);
} // namespace Exemplar

#endif
