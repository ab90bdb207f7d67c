// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_adjoint_solve_h
#define exemplar_adjoint_solve_h

#include <exemplar/run/adjoint/slope_derivatives.h>
#include <exemplar/solvers/step_system.h>

#include <functional>

namespace Exemplar
{
  /// The direction (a, b) with Phi'' (a, b) = (dJ/dx, dJ/dw) on the free degrees of freedom and the weights
  /// that are at no bound, whose changes keep the sums of each region; zero elsewhere.
  struct AdjointSolution
  {
    Direction        direction;
    SlopeDerivatives derivatives; ///< of the slope along it
  };

  /// All derivatives of the slope along a direction.
  using FindDerivatives = std::function<SlopeDerivatives(const Direction &)>;

  /// The equations of that direction at one state after the other; with Z = A^-1 G they are those of Eq. (11).
  /// The pattern of the matrix is analysed once.
  class AdjointSystem
  {
  public:
    /// The problem must outlive it, and hold the same nodes.
    explicit AdjointSystem(Problem &problem);

    /// Go to the problem's state, at which its potential was evaluated last. Throws SolverFailure if the
    /// exact tangent there is not positive definite.
    void
    factorize();

    /// Solved by the factor, and corrected until what `find` tells agrees with the right side. Throws
    /// SolverFailure if it does not come to agree.
    AdjointSolution
    solve(const Direction &by_state, const FindDerivatives &find);

  private:
    /// Add to the direction what takes this right side to zero.
    void
    add_solution(const Direction &right_side, Direction &direction);

    /// What a direction with these derivatives leaves of a right side, with the multiplier of each region
    /// that takes most of it; returns its size relative to that of `by_state`.
    double
    residual(const Direction        &by_state,
             const Direction        &direction,
             const SlopeDerivatives &derivatives,
             Direction              &rest);

    /// The greatest sum of magnitudes in G^T a and H b, which may cancel.
    double
    scale_of_terms(const Direction &direction);

    void
    subtract_multipliers(Direction &rest) const;

    void
    make_weight_matrix();

    std::vector<double>
    solve_weights(const Direction &right_side) const;

    Problem                         &problem;
    const std::vector<unsigned int> &free;
    const WeightForm                &form;
    StepSystem                       system;
    std::vector<bool>                inactive;
    std::vector<double>              Z; ///< A^-1 G
    dealii::FullMatrix<double>       inverse;
    double                           size_of_sums = 1.;
  };

  /// Of a static problem at its state.
  AdjointSolution
  solve_adjoint(Problem &problem, const Direction &by_state);

  /// Whether steps find this weight and no bound holds it.
  std::vector<bool>
  are_inactive(const Problem &problem);
} // namespace Exemplar

#endif
