// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_fold_solver_h
#define exemplar_fold_solver_h

#include <exemplar/surface/posing/fold_system.h>

#include <vector>

namespace Exemplar
{
  /// Minimises a FoldPotential so that no cell is inverted in the end.
  class FoldSolver
  {
  public:
    using Points = FoldPotential::Points;

    /// det F of a cell that counts as not inverted is greater.
    static constexpr double margin = 1e-3;

    /// Where the nodes are, and how they came there.
    struct Result
    {
      Points       x;               ///< [m]
      double       min_det    = 1.; ///< of F over the cells
      unsigned int iterations = 0;  ///< of Newton's method
      unsigned int releases   = 0;  ///< how often springs were softened
    };

    /// `potential` must outlive this; its springs may change between solutions.
    explicit FoldSolver(FoldPotential &potential);

    /// From the nearest rotations of the cells, which may invert some, through less and less
    /// regularised energies to one that is infinite for inverted cells. Springs around cells that
    /// stay inverted are softened, in the potential, and the search goes on. If that does not help
    /// either, from `rest`, the nodes at rest, and never through an inverted cell. There remain
    /// inverted cells only if Result::min_det is not greater than the margin.
    Result
    solve(const Points &rest);

    /// Goes on from a solution towards the places of the skin's vertices: with springs of `stiffness`
    /// [1/m^2], one a vertex, and then with stronger and stronger ones where cells can bear it, as long as
    /// that brings the vertices clearly nearer. Cells that are nearly flat are not pulled at, and where a
    /// step would make a pose worse the one before it is the last.
    void
    draw_nearer(Result &result, const std::vector<double> &stiffness);

  private:
    Points
    nearest_rotations() const;
    void
    untangle(Result &result, double eps, double min_share, std::size_t n_left);
    void
    untangle_neighbourhoods(Result &result, const Points &rest);
    void
    settle(Result &result, double share);
    double
    step(Result &result, double eps);
    void
    release(Result &result);

    FoldPotential &potential;
    FoldSystem     system;
  };
} // namespace Exemplar

#endif
