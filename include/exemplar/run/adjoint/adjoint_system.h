// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_adjoint_system_h
#define exemplar_adjoint_system_h

#include <exemplar/run/adjoint/slope_derivatives.h>
#include <exemplar/solvers/step_system.h>

namespace Exemplar
{
  /// The equations of AdjointSolution at one state after the other; with Z = A^-1 G they are those of Eq. (11).
  /// The pattern of the matrix is analysed once.
  class AdjointSystem
  {
  public:
    /// The problem must outlive it, and hold the same nodes.
    explicit AdjointSystem(Problem &problem);

    /// Go to the problem's state, where its potential has this evaluation. Throws SolverFailure if the exact
    /// tangent there is not positive definite, unless cells are guarded by Eq. (16).
    void
    go_to_state(const Evaluation &evaluation);

    /// Let the factor have all digits at this state and those to come. Returns whether it had fewer.
    bool
    sharpen();

    /// Add to the direction what takes this right side to zero, by the factor.
    void
    add_solution(const Direction &right_side, Direction &direction);

    /// What a direction with these derivatives leaves of a right side, with the multiplier of each region
    /// that takes most of it; returns its size relative to that of `by_state`.
    double
    residual(const Direction        &by_state,
             const Direction        &direction,
             const SlopeDerivatives &derivatives,
             Direction              &rest);

    Direction
    zero() const;

    /// A residual without what is held, what is at a bound, and the multipliers.
    Direction
    projected(Direction rest) const;

    /// What a weight's residual [J] counts beside one of a degree of freedom [N].
    double
    scale_of_weights();

  private:
    void
    make_factor();

    void
    factorize();

    void
    factorize(double convexity);

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
    bool         is_rough      = true; ///< refined solutions need few digits of a factor
    unsigned int guarded_cells = 0;    ///< at the state
  };
} // namespace Exemplar

#endif
