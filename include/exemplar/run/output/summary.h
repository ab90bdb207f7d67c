// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_summary_h
#define exemplar_summary_h

#include <exemplar/run/adjoint/functional.h>
#include <exemplar/run/frames/space_error.h>
#include <exemplar/run/output/checkpoint.h>
#include <exemplar/run/problem/problem.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Estimates of the last step, if the scene asks for them.
  struct LastEstimates
  {
    std::optional<SpaceError>       space_error;
    std::optional<FunctionalReport> functional;
  };

  /// Write summary.json: the program, the scene's sizes, totals over all steps, the warnings of the
  /// run, estimates of its last step, and the parts of the problem in use and not in use.
  void
  write_summary(Problem                        &problem,
                const RunTotals                &totals,
                const LastEstimates            &last,
                const std::string              &mesh_sha256,
                const std::string              &status,
                const std::vector<std::string> &warnings,
                const std::filesystem::path    &file);
} // namespace Exemplar

#endif
