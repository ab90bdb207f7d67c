// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_study_report_h
#define exemplar_study_report_h

#include <exemplar/study/study_table.h>

#include <filesystem>

namespace Exemplar
{
  /// Write study.md: the settings, a table for each combination on the axes other than the numeric
  /// one, with observed orders if there is a reference, and the failures.
  void
  write_study_report(const Study                 &study,
                     const StudyTable            &table,
                     const std::filesystem::path &file);
} // namespace Exemplar

#endif
