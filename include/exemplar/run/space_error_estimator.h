// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_space_error_estimator_h
#define exemplar_space_error_estimator_h

#include <exemplar/run/problem.h>
#include <exemplar/run/space_error.h>

#include <memory>

namespace Exemplar
{
  /// Estimates errors in space by a quadratic correction, doc/space.md: one Newton step of the same
  /// scene in quadratic elements, with the mean dilatation of each cell, from the state of the
  /// linear ones. What the linear elements leave of their own equations is taken out before.
  class SpaceErrorEstimator
  {
  public:
    /// The problem must keep its inputs and outlive this.
    explicit SpaceErrorEstimator(Problem &problem);

    ~SpaceErrorEstimator();

    /// At the problem's state, which does not change. The first call makes the quadratic
    /// problem, which takes about ten times the memory of the linear one.
    SpaceError
    estimate();

  private:
    struct Correction;

    /// `linear` is the evaluation of the linear elements without inertia.

    Correction
    correct(const Evaluation &linear);

    /// By the tangent of this convexity, from where the quadratic problem is. Throws SolverFailure if
    /// it is not definite.
    void
    solve(double convexity, Correction &correction);

    /// The quadratic problem at the linear state, under the loads and the inertia that hold that in
    /// equilibrium.
    State
    take_over(const Evaluation &linear);

    Problem                 &problem;
    std::unique_ptr<Problem> quadratic;
  };
} // namespace Exemplar

#endif
