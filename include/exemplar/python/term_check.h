// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_term_check_h
#define exemplar_term_check_h

#include <exemplar/python/function_answer.h>

#include <string>

// Checks by central differences that the results of a term's function are consistent: the gradient
// is the slope of the energy, and the Hessian that of the gradient, without negative eigenvalues.

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
    double gradient  = 0.; ///< relative error of the gradient, from the energy
    double hessian   = 0.; ///< relative error of the Hessian, from the gradient
    double curvature = 0.; ///< least curvature of the Hessian found [N/m]
  };

  /// Checks a term along some directions from the place of an answer. Throws UserError, which names
  /// the term, for a gradient that is not the energy's, a Hessian that lacks stiffness, and one
  /// with a negative curvature; and what the function raises.
  TermCheck
  check(const NamedTerm &term, const FunctionAnswer &at);

  /// A message if the gradient is grossly different from the slope of the energy along it; else
  /// empty, as far as two calls of the function tell. Throws what the function raises.
  std::string
  complaint_of_gradient(const NamedTerm &term, const FunctionAnswer &at);

  /// A message if the Hessian has a negative curvature; empty if none was found.
  std::string
  complaint_of_curvature(const std::string &name, const FunctionAnswer &at);
} // namespace Exemplar::Python

#endif
