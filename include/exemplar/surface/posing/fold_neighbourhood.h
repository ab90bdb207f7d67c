// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_fold_neighbourhood_h
#define exemplar_fold_neighbourhood_h

#include <exemplar/surface/posing/fold_potential.h>

namespace Exemplar
{
  /// The surroundings of some cells of a body as a body of their own, which is small where these
  /// cells are few. Nodes outside of it are held where they are.
  class FoldNeighbourhood
  {
  public:
    using Points = FoldPotential::Points;

    /// The neighbourhood of the marked nodes: `n_rings` >= 1 rings of cells around them. `rest` and
    /// `x` are the nodes of the whole body at rest and now.
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

    /// Places of the neighbourhood's nodes at the beginning [m].
    const Points &
    get_start() const
    {
      return start;
    }

    /// Write places of the neighbourhood's nodes to those of the whole body.
    void
    copy_back(const Points &of_neighbourhood, Points &x) const;

  private:
    /// Number in the neighbourhood of each node of the body, or -1; nodes and cells of the
    /// neighbourhood.
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

    std::vector<char> free; ///< which nodes of the whole body may move
    Numbering         numbering;
    Points            start;
    FoldPotential     potential;
  };

  /// `marked` grown by n_rings rings of cells: nodes of cells with a marked node are marked,
  /// n_rings times.
  std::vector<char>
  grown(const FoldPotential::Cells &cells, std::vector<char> marked, unsigned int n_rings);
} // namespace Exemplar

#endif
