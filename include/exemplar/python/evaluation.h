// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_python_evaluation_h
#define exemplar_python_evaluation_h

#include <exemplar/python/problem_type.h>

namespace Exemplar::Python
{
  /// Ask the laboratory of a problem without Python's lock; `what` is called for that. Throws as
  /// HeldProblem::change().
  template <typename Function>
  void
  ask(HeldProblem &held, const std::string &what, const Function &function)
  {
    held.use(what, [&function](Problem &problem) { function(problem.laboratory()); });
  }

  /// Of exemplar.Problem energies, forces and matrices anywhere.
  void
  add_evaluation(ProblemClass &problem);
} // namespace Exemplar::Python

#endif
