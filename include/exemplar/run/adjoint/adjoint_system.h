// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_adjoint_system_h
#define exemplar_adjoint_system_h

#include <exemplar/run/adjoint/slope_derivatives.h>
#include <exemplar/solvers/step_system.h>

namespace Exemplar
{
  /// The linear equations of AdjointSolution at one state after the other; with Z = A^-1 G they are
  /// those of Eq. (11). The sparsity pattern is analysed once.
  class AdjointSystem
  {
  public:
    /// The problem must outlive it, and keep the same free nodes.
    explicit AdjointSystem(Problem &problem);

    /// Move to the problem's state, where its potential has this evaluation, and factorise. Throws
    /// SolverFailure if the exact tangent there is not positive definite, unless cells are guarded
    /// by Eq. (16).
    void
    go_to_state(const Evaluation &evaluation);

    /// Factorise in full precision at this state and later ones. Returns whether the precision was
    /// lower.
    bool
    sharpen();

    /// Add to `direction` the solution of the factorised equations with this right side.
    void
    add_solution(const Direction &right_side, Direction &direction);

    /// rest = by_state - Phi'' direction, less the multiplier of each region (the mean of its
    /// weights). Returns the greatest entry, relative to the greatest of the terms that cancel.
    double
    residual(const Direction        &by_state,
             const Direction        &direction,
             const SlopeDerivatives &derivatives,
             Direction              &rest);

    Direction
    zero() const;

    /// Factor that makes residuals of weights [J] comparable to those of degrees of freedom [N].
    double
    scale_of_weights();

  private:
    void
    make_factor();

    void
    factorize();

    void
    factorize(double convexity);

    /// The greatest entry of G b, the scale of the forces if J depends on the weights alone.
    double
    greatest_of_columns(const Direction &direction);

    /// The greatest sum of magnitudes in G^T a and H b, whose terms may cancel.
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
    bool is_rough = true; ///< whether factors have low precision, which refined solutions allow
    unsigned int guarded_cells = 0; ///< number of them at the state
  };
} // namespace Exemplar

#endif
