// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_space_error_estimator_h
#define exemplar_space_error_estimator_h

#include <exemplar/run/frames/space_error.h>
#include <exemplar/run/problem/problem.h>

#include <memory>
#include <optional>

namespace Exemplar
{
  /// Estimates the discretisation error by a quadratic correction, doc/choosing.md: from the state
  /// of linear elements to that of quadratic ones under the same forces, by one Newton step if the
  /// problem is linear. Quadratic elements have a mean dilatation in each cell if the strain
  /// allows. The residual of the linear elements' own equations is subtracted first.
  class SpaceErrorEstimator
  {
  public:
    /// The problem must keep its inputs and outlive this.
    explicit SpaceErrorEstimator(Problem &problem);

    ~SpaceErrorEstimator();

    /// Estimate at the problem's state, which is left unchanged. The first call makes the quadratic
    /// problem, with about ten times the memory of the linear one.
    SpaceError
    estimate();

  private:
    struct Correction;

    /// Newton's method from the linear state, under the forces at that state. `linear` is the
    /// evaluation of the linear elements without inertia.
    Correction
    correct(const Evaluation &linear);

    /// The quadratic problem at the linear state, under the loads and the inertia with which that
    /// is in equilibrium.
    Correction
    take_over(const Evaluation &linear);

    Evaluation
    evaluate(const Correction &correction);

    /// Make a step that decreases the potential, by the exact tangent or else the convex one. Returns
    /// whether a further one would improve the estimate, and nothing if no step was made. Throws
    /// SolverFailure if no tangent is definite.
    std::optional<bool>
    improve(Correction &correction);

    std::optional<bool>
    improve_by(Tangent tangent, Correction &correction);

    Problem                 &problem;
    std::unique_ptr<Problem> quadratic;
  };
} // namespace Exemplar

#endif
