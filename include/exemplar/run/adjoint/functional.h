// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_functional_h
#define exemplar_functional_h

#include <exemplar/run/adjoint/slope_derivatives.h>

#include <functional>
#include <optional>
#include <string>

// The number that Output/Functional names.

namespace Exemplar
{
  /// A number J(x, w) at the state of a problem, and its derivatives.
  struct FunctionalValue
  {
    double    value;
    Direction by_state;
  };

  using Functional = std::function<FunctionalValue(Problem &)>;

  /// The functional of this name in Output/Functional: energy_elastic, reaction_NAME_x or
  /// displacement_x of SELECTION. Throws UserError for anything else.
  Functional
  make_functional(const std::string &name, const Problem &problem);

  /// The functional's entry in summary.json.
  struct FunctionalReport
  {
    std::string           name;
    double                value;
    std::optional<double> correction; ///< see correction(); nothing after a failure
    std::string           failure;    ///< why there is no correction
  };

  /// Throws UserError if the scene names a functional that does not exist there, or one whose
  /// gradients are not known.
  void
  require_functional(const Problem &problem);

  /// Value and correction after the last step of a scene that names a functional; else nothing.
  std::optional<FunctionalReport>
  functional_at_end(Problem &problem);
} // namespace Exemplar

#endif
