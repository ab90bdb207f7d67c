// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_step_adjoint_h
#define exemplar_step_adjoint_h

#include <exemplar/run/adjoint/adjoint_inverse.h>
#include <exemplar/run/adjoint/adjoint_solve.h>

#include <functional>

namespace Exemplar
{
  /// All derivatives of the slope along a direction.
  using FindDerivatives = std::function<SlopeDerivatives(const Direction &)>;

  /// The equations of AdjointSolution at one state after the other. The pattern of the matrix is analysed once,
  /// and conjugate gradients with the exact tangent of a state go on with the factor of an earlier one as
  /// long as it serves.
  class StepAdjoint
  {
  public:
    /// Solved to a residual of `tolerance` times the right side. The problem must outlive it, and hold the
    /// same nodes.
    explicit StepAdjoint(Problem &problem, double tolerance);

    /// Go to the problem's state, at which its potential was evaluated last.
    void
    go_to_state();

    /// Solved until what `find` tells agrees with the right side. Throws SolverFailure if it does not come
    /// to agree, or the exact tangent is not positive definite.
    AdjointSolution
    solve(const Direction &by_state, const FindDerivatives &find);

    unsigned int
    n_factorizations() const
    {
      return factorizations;
    }

  private:
    void
    factorize();

    /// Add to the direction what takes a right side to zero, beside by_state.
    void
    add_solution(const Direction &right_side, const Direction &by_state, Direction &direction);

    /// Conjugate gradients from zero: whether they come to an end.
    bool
    find_solution(BorderedVector right_side, const Direction &by_state, BorderedVector &solution);

    /// Phi'' times a vector on free degrees of freedom.
    BorderedVector
    product(const BorderedVector &vector) const;

    /// What is left of a right side, over its size and that of terms that cancel in it for this direction.
    /// Of the weights at no bound the mean of each region is no residual, but its multiplier.
    double
    residual(const BorderedVector &rest,
             const Direction      &by_state,
             const BorderedVector &direction) const;

    BorderedVector
    free_part(const Direction &direction) const;

    Problem                              &problem;
    const double                          tolerance;
    const std::vector<unsigned int>      &free;
    const WeightForm                     &form;
    const std::unique_ptr<BorderedSystem> system;
    std::vector<bool>                     inactive;
    AdjointInverse                        inverse;
    bool                                  is_worn        = true;  ///< the inverse, or there is none
    bool                                  is_own         = false; ///< it is of this state
    unsigned int                          factorizations = 0;
  };
} // namespace Exemplar

#endif
