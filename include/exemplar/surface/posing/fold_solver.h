// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_fold_solver_h
#define exemplar_fold_solver_h

#include <exemplar/surface/posing/fold_potential.h>

#include <functional>
#include <memory>
#include <vector>

namespace Exemplar
{
  /// The linear system of a step of Newton's method for a FoldPotential.
  class FoldSystem
  {
  public:
    /// `potential` must outlive this.
    explicit FoldSystem(const FoldPotential &potential);

    /// Factorizes the Hessian of FoldPotential::assemble(), with the springs of the skin, at these
    /// places of the nodes. Throws SolverFailure if it has no factor.
    void
    factorize(const FoldPotential::Points &x, double eps);

    /// The solution for a right-hand side: by the factor alone, or, with springs of the skin, of
    /// which the factor has only a diagonal bound, by conjugate gradients preconditioned by it.
    std::vector<double>
    solve(const std::vector<double> &right_side) const;

  private:
    void
    factorize_shifted();

    const FoldPotential         &potential;
    std::unique_ptr<SpdOperator> system;
    SymmetricPattern             pattern;
    std::vector<double>          without_skin; ///< Hessian without the skin's springs
  };

  /// Minimises a FoldPotential so that no cell is inverted in the end.
  class FoldSolver
  {
  public:
    using Points = FoldPotential::Points;

    /// A cell counts as inverted unless its det F is greater than this.
    static constexpr double margin = 1e-3;

    /// Places of the nodes, and how they were found.
    struct Result
    {
      Points       x;               ///< [m]
      double       min_det    = 1.; ///< least det F of the cells
      unsigned int iterations = 0;  ///< steps of Newton's method
      unsigned int releases   = 0;  ///< times that springs were softened
    };

    /// `potential` must outlive this; its springs may change between solutions.
    explicit FoldSolver(FoldPotential &potential);

    /// Minimises from the nearest rotations of the cells, which may invert some, through less and
    /// less regularised energies to one that is infinite for inverted cells. Springs around cells
    /// that stay inverted are softened, in the potential, and the search goes on. If that fails, it
    /// minimises from `rest`, the nodes at rest, and never through an inverted cell. Inverted cells
    /// remain only if Result::min_det is not greater than the margin.
    Result
    solve(const Points &rest);

    /// Goes on from a solution towards the places of the skin's vertices: with springs of
    /// `stiffness` [1/m^2], one for each vertex, and then with stronger and stronger ones around
    /// cells that are not too flat, as long as the vertices come clearly nearer. Vertices beside
    /// nearly flat cells are not pulled at; a step that makes a pose worse is undone and is the
    /// last.
    void
    draw_nearer(Result &result, const std::vector<double> &stiffness);

    /// Called after each step of Newton's method in the whole body, with their number; or empty.
    std::function<void(unsigned int)> tell;

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
