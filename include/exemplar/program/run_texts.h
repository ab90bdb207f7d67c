// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_run_texts_h
#define exemplar_run_texts_h

#include <exemplar/run/output/run_writer.h>
#include <exemplar/run/problem/problem.h>

#include <string>

// What a run tells its user, in lines that are ended.

namespace Exemplar
{
  /// What is solved, on what body and how. All processes that share the body must call this.
  /// From where a run goes on.
  std::string
  resumption_text(const Problem &problem);

  std::string
  header_text(const Problem &problem);

  /// What the run has cost, and what is known of the errors of its steps and of its mesh.
  std::string
  closing_text(const Problem &problem, const RunWriter &writer);

  /// From where the last step was solved and what was found, a line each; empty unless Solver/Starts asks.
  std::string
  starts_text(const Problem &problem);

  /// What a step, or its last iteration, has come to.
  std::string
  progress_text(const SolveReport &report);

  /// A line for an iteration of the step under way.
  std::string
  iteration_text(const Problem &problem, const SolveReport &report);
} // namespace Exemplar

#endif
