// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_study_report_h
#define exemplar_study_report_h

#include <exemplar/study/study_table.h>

#include <filesystem>

namespace Exemplar
{
  /// study.md: what was run, a table for each combination of the axes other than the numeric
  /// one, with observed orders where there is a reference, and what failed.
  void
  write_study_report(const Study                 &study,
                     const StudyTable            &table,
                     const std::filesystem::path &file);
} // namespace Exemplar

#endif
