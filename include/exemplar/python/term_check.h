// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_term_check_h
#define exemplar_term_check_h

#include <exemplar/python/function_answer.h>

#include <string>

// Whether what the function of a term returns fits together: its gradient is the slope of its energy, and
// its Hessian that of its gradient, without negative eigenvalues. By central differences.

namespace Exemplar::Python
{
  /// The function of a term, and what messages call it.
  struct NamedTerm
  {
    const pybind11::object &function;
    std::string             name;
  };

  /// The differences that were found at a place.
  struct TermCheck
  {
    double gradient  = 0.; ///< of the gradient from the slope of the energy, relative
    double hessian   = 0.; ///< of the Hessian from the slope of the gradient, relative
    double curvature = 0.; ///< least one of the Hessian that was found [N/m]
  };

  /// Along some directions from the place of an answer. Throws UserError, which names the term, for a
  /// gradient that is not the energy's, a Hessian that lacks stiffness, and one with a negative
  /// curvature; and what the function raises.
  TermCheck
  check(const NamedTerm &term, const FunctionAnswer &at);

  /// That the gradient is grossly not the slope of the energy along it, as a message; empty: it is, as far as
  /// two calls of the function tell. Throws what the function raises.
  std::string
  complaint_of_gradient(const NamedTerm &term, const FunctionAnswer &at);

  /// That the Hessian has a negative curvature, as a message; empty: none was found.
  std::string
  complaint_of_curvature(const std::string &name, const FunctionAnswer &at);
} // namespace Exemplar::Python

#endif
