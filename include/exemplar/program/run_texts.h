// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_run_texts_h
#define exemplar_run_texts_h

#include <exemplar/run/output/run_writer.h>
#include <exemplar/run/problem/problem.h>

#include <string>

// Texts of a run for its user; each line ends in a newline.

namespace Exemplar
{
  /// The step after which a run continues, and whether any steps are left.
  std::string
  resumption_text(const Problem &problem);

  /// Header of a run: the problem, its body and methods. All processes that share the body must
  /// call this.
  std::string
  header_text(const Problem &problem);

  /// Costs of the run, and estimated errors of its steps and its mesh.
  std::string
  closing_text(const Problem &problem, const RunWriter &writer);

  /// Starts of the last step and their outcomes, a line each; empty without Solver/Starts =
  /// examples.
  std::string
  starts_text(const Problem &problem);

  /// Outcome of a step or of its last iteration.
  std::string
  progress_text(const SolveReport &report);

  /// A line for an iteration of the current step.
  std::string
  iteration_text(const Problem &problem, const SolveReport &report);
} // namespace Exemplar

#endif
