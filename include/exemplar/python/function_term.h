// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_python_function_term_h
#define exemplar_python_function_term_h

#include <exemplar/python/function_answer.h>

namespace Exemplar::Python
{
  /// A term of Phi that calls function(positions (n,3), time) -> energy, gradient (n,3), sparse
  /// Hessian (3n,3n) or None, with Python's lock held. `function` is looked at in each call and
  /// must outlive the term. It is called at once at this state. Exceptions of the function pass
  /// through; UserError is thrown if it returns anything else.
  std::unique_ptr<PotentialTerm>
  make_function_term(const pybind11::object &function, std::string name, const State &state);

  /// The answers of a term's function: that for the last state, and the last one of all.
  struct TermAnswers
  {
    const FunctionAnswer &of_state, &last;
  };

  /// The answers of a term that make_function_term() has made.
  TermAnswers
  answers_of(const PotentialTerm &term);
} // namespace Exemplar::Python

#endif
