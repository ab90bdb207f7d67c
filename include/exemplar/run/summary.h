// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_summary_h
#define exemplar_summary_h

#include <exemplar/run/checkpoint.h>
#include <exemplar/run/problem.h>

#include <filesystem>
#include <string>

namespace Exemplar
{
  /// Write summary.json: the program, the scene's sizes, totals over all steps, what
  /// was used and what was left out.
  void
  write_summary(Problem                     &problem,
                const RunTotals             &totals,
                const std::string           &mesh_sha256,
                const std::string           &status,
                const std::filesystem::path &file);
} // namespace Exemplar

#endif
