// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_study_table_h
#define exemplar_study_table_h

#include <exemplar/study/study_file.h>
#include <exemplar/study/study_measures.h>

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Times of the repeats of a run [s].
  struct RunSeconds
  {
    double median  = std::numeric_limits<double>::quiet_NaN();
    double minimum = std::numeric_limits<double>::quiet_NaN();
  };

  /// Results of a run of a study; NaN if unknown.
  struct StudyRow
  {
    std::vector<unsigned int> choice; ///< on each axis
    std::string               status;
    int                       exit_status = 0;
    std::string               message;
    std::string               run; ///< its directory under runs
    RunSeconds                seconds;
    double                    error_energy     = std::numeric_limits<double>::quiet_NaN();
    double                    max_displacement = std::numeric_limits<double>::quiet_NaN();
    PoseErrors                errors;
    RunStatistics             statistics;
    RunSummary                summary;
    std::vector<double>       extra; ///< values of the columns that the study requests
  };

  /// The rows of a study in the order of its combinations.
  struct StudyTable
  {
    std::vector<StudyAxis>   axes;
    std::vector<StudyRow>    rows;
    bool                     has_reference = false;
    std::vector<std::string> extra_columns = {};
  };

  /// The columns that a study requests.
  std::vector<std::string>
  extra_columns_of(const Study &study);

  /// Rows that differ on the numeric axis only.
  struct StudyLine
  {
    std::vector<unsigned int>     choice; ///< on the other axes
    std::string                   title;  ///< their values
    std::vector<const StudyRow *> rows;
  };

  /// The number of a choice; for numbers separated by commas, such as Mesh/Box cells, their
  /// geometric mean. Of keys that vary together the first counts. NaN if it is no number.
  double
  number_of(const StudyAxis &axis, unsigned int choice);

  /// The first axis with at least two different numbers; nothing if there is none.
  std::optional<unsigned int>
  numeric_axis(const std::vector<StudyAxis> &axes);

  /// The rows by line; a single line if there is no numeric axis.
  std::vector<StudyLine>
  lines_of(const StudyTable &table);

  /// p in error ~ number^p between two points; NaN if undefined.
  double
  observed_order(double error_1, double error_2, double number_1, double number_2);

  /// Throws UserError if study.csv has its own column of such a name.
  void
  check_extra_columns(const Study &study);

  /// Write study.csv, a line a row.
  void
  write_study_csv(const StudyTable &table, const std::filesystem::path &file);
} // namespace Exemplar

#endif
