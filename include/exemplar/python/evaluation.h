// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_python_evaluation_h
#define exemplar_python_evaluation_h

#include <exemplar/python/problem_type.h>

namespace Exemplar::Python
{
  /// Call `function` with the laboratory of a problem, without Python's lock; `what` is the name of
  /// the caller. Throws as HeldProblem::use().
  template <typename Function>
  void
  ask(HeldProblem &held, const std::string &what, const Function &function)
  {
    held.use(what, [&function](Problem &problem) { function(problem.laboratory()); });
  }

  /// Adds to exemplar.Problem the evaluation of energies, forces and matrices at any positions.
  void
  add_evaluation(ProblemClass &problem);
} // namespace Exemplar::Python

#endif
