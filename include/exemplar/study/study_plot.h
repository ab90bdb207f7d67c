// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_study_plot_h
#define exemplar_study_plot_h

#include <exemplar/study/study_directory.h>
#include <exemplar/study/study_table.h>

namespace Exemplar
{
  /// The points that no other dominates in both coordinates, by ascending first coordinate.
  std::vector<std::pair<double, double>>
  pareto_front(std::vector<std::pair<double, double>> points);

  /// Write study.gnuplot and study.svg: error against run time; nothing if there are no errors.
  /// Returns a warning if gnuplot is missing or fails, else an empty text.
  std::string
  plot_study(const StudyTable &table, const std::string &title, const StudyDirectory &directory);
} // namespace Exemplar

#endif
