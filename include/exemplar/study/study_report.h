// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_study_report_h
#define exemplar_study_report_h

#include <exemplar/study/study_directory.h>
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

  /// The points that no other dominates in both coordinates, by ascending first coordinate.
  std::vector<std::pair<double, double>>
  pareto_front(std::vector<std::pair<double, double>> points);

  /// Write study.gnuplot and study.svg: error against run time; nothing if there are no errors.
  /// Returns a warning if gnuplot is missing or fails, else an empty text.
  std::string
  plot_study(const StudyTable &table, const std::string &title, const StudyDirectory &directory);
} // namespace Exemplar

#endif
