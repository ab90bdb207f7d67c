// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_space_error_estimator_h
#define exemplar_space_error_estimator_h

#include <exemplar/run/frames/space_error.h>
#include <exemplar/run/problem/problem.h>

#include <memory>

namespace Exemplar
{
  /// Estimates errors in space by a quadratic correction, doc/choosing.md: from the state of the linear
  /// elements to that of quadratic ones under the same forces, in one Newton step where all is
  /// linear. Where the strain allows they have the mean dilatation of each cell. What the linear
  /// elements leave of their own equations is taken out before.
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

    /// Newton's method from the linear state, with the forces that it has there. `linear` is the
    /// evaluation of the linear elements without inertia.
    Correction
    correct(const Evaluation &linear);

    /// The quadratic problem at the linear state, under the loads and the inertia that hold that in
    /// equilibrium.
    Correction
    take_over(const Evaluation &linear);

    Evaluation
    evaluate(const Correction &correction);

    /// Throws SolverFailure if no tangent is definite.
    BorderedVector
    direction(const Correction &correction);

    /// A step that lessens the potential. Returns whether a further one would tell more.
    bool
    improve(Correction &correction);

    Problem                 &problem;
    std::unique_ptr<Problem> quadratic;
  };
} // namespace Exemplar

#endif
