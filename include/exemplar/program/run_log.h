// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_run_log_h
#define exemplar_run_log_h

#include <exemplar/base/process_group.h>
#include <exemplar/run/output/run_writer.h>
#include <exemplar/run/problem/problem.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Messages of a run other than its progress, on the terminal and in a file. With several
  /// processes, the root alone writes.
  class RunLog
  {
  public:
    /// If `quiet`, the terminal shows warnings alone.
    explicit RunLog(bool quiet);

    /// Print lines, each with its newline, and write them to the file.
    void
    say(const std::string &lines);

    /// Print a warning on stderr, and write it to the file.
    void
    warn(const std::string &warning);

    void
    warn(const std::vector<std::string> &all);

    /// Write lines to the file only.
    void
    note(const std::string &lines);

    /// Append all messages to this file from now on, after those so far. Throws std::runtime_error,
    /// as all functions do from now on, if it cannot be written.
    void
    keep_in(const std::filesystem::path &path);

    /// All warnings so far.
    const std::vector<std::string> &
    get_warnings() const
    {
      return warnings;
    }

  private:
    const ProcessGroup      &processes;
    const bool               quiet;
    std::vector<std::string> warnings;
    std::string              waiting; ///< text for the file, not yet written
    std::filesystem::path    path;    ///< empty: no file yet
    std::ofstream            file;
  };

  // The lines of these texts end in a newline.

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
