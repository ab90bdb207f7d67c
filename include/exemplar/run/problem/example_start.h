// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_example_start_h
#define exemplar_example_start_h

#include <exemplar/solvers/solve_report.h>

#include <string>

namespace Exemplar
{
  /// A start of the search for the equilibrium of a static scene, and its outcome.
  struct ExampleStart
  {
    std::string from;
    SolveStatus status;
    double      energy; ///< Phi there [J]
    bool        is_kept;
  };
} // namespace Exemplar

#endif
