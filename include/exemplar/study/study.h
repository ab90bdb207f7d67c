// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_study_h
#define exemplar_study_h

#include <exemplar/base/child_process.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Runs a command as run_child() does.
  using RunProgram = std::function<ChildEnd(const std::vector<std::string> &command,
                                            const std::filesystem::path    &log,
                                            double                          timeout,
                                            const std::function<bool()>    &stop)>;

  /// Options of `exemplar study`.
  struct StudyOptions
  {
    std::filesystem::path file;
    std::filesystem::path output; ///< empty: output/NAME of the study file
    bool                  quiet = false;
    std::function<bool()> stop; ///< polled from the first run on: true interrupts the study
    RunProgram            run_program = run_child;
  };

  /// Make the missing runs of a study, each in its own process, and write its tables and figure.
  /// Throws UserError before anything is written; Interrupted with all finished runs on disk.
  void
  run_study(const StudyOptions &options);

  /// Check a study, the scenes of all its runs and the files of one, without computing or writing.
  /// Throws UserError.
  void
  validate_study(const std::filesystem::path &file);

  /// Print every key of a study file with its default, range and meaning, as a .prm.
  void
  print_study_parameters();
} // namespace Exemplar

#endif
