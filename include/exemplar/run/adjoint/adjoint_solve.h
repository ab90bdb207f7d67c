// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_adjoint_solve_h
#define exemplar_adjoint_solve_h

#include <exemplar/run/adjoint/adjoint_inverse.h>
#include <exemplar/run/adjoint/slope_derivatives.h>

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

  /// The equations of that direction at one state after the other. The pattern of the matrix is analysed once,
  /// and conjugate gradients with the exact tangent of a state go on with the factor of an earlier one as
  /// long as it serves.
  class AdjointSystem
  {
  public:
    /// Solved to a residual of `tolerance` times the right side. The problem must outlive it, and hold the
    /// same nodes.
    explicit AdjointSystem(Problem &problem, double tolerance = 1e-9);

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

  /// Of a static problem at its state.
  AdjointSolution
  solve_adjoint(Problem &problem, const Direction &by_state);

  /// Whether steps find this weight and no bound holds it.
  std::vector<bool>
  are_inactive(const Problem &problem);
} // namespace Exemplar

#endif
