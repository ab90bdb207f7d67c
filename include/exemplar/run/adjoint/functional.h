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

  /// Of a name as the scene has it: energy_elastic, reaction_NAME_x or displacement_x of SELECTION. Throws
  /// UserError for anything else.
  Functional
  make_functional(const std::string &name, const Problem &problem);

  /// What summary.json says of it.
  struct FunctionalReport
  {
    std::string           name;
    double                value;
    std::optional<double> correction; ///< see correction(); nothing after a failure
    std::string           failure;    ///< why there is no correction
  };

  /// Throws UserError if the scene names a functional that it has not, or one whose gradients are not
  /// known.
  void
  require_functional(const Problem &problem);

  /// At the state after the last step of a scene that names a functional, else nothing.
  std::optional<FunctionalReport>
  functional_at_end(Problem &problem);
} // namespace Exemplar

#endif
