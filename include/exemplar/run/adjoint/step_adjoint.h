// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_step_adjoint_h
#define exemplar_step_adjoint_h

#include <exemplar/run/adjoint/adjoint_solve.h>
#include <exemplar/solvers/step_system.h>

#include <functional>

namespace Exemplar
{
  /// All derivatives of the slope along a direction.
  using FindDerivatives = std::function<SlopeDerivatives(const Direction &)>;

  /// The equations of AdjointSolution at one state after the other; with Z = A^-1 G they are those of Eq. (11).
  /// The pattern of the matrix is analysed once.
  class StepAdjoint
  {
  public:
    /// The problem must outlive it, and hold the same nodes.
    explicit StepAdjoint(Problem &problem);

    /// Go to the problem's state, at which its potential was evaluated last. Throws SolverFailure if the
    /// exact tangent there is not positive definite.
    void
    go_to_state();

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

    /// The greatest entry of G b, which a function of the weights alone has for its forces.
    double
    greatest_of_columns(const Direction &direction);

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
} // namespace Exemplar

#endif
