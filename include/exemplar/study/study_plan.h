// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_study_plan_h
#define exemplar_study_plan_h

#include <exemplar/study/study_runs.h>

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace Exemplar
{
  /// The runs of a study, all checked.
  class StudyPlan
  {
  public:
    /// Throws UserError if a key is unknown, if the reference's values are refused, if the problem
    /// of the reference (without one, of the first run whose values are allowed) cannot be built,
    /// or if no run has a requested column. Runs whose values are refused stay in the plan; a
    /// warning and their rows tell of it.
    explicit StudyPlan(const Study &study);

    /// Number of runs to be made, repeats included.
    unsigned int
    n_repeats() const;

    /// Names of all runs and of the reference.
    std::vector<std::string>
    names() const;

    const Study              &study;
    const std::string         scene_text;
    std::optional<PlannedRun> reference;
    std::vector<PlannedRun>   runs;
    std::vector<std::string>  warnings; ///< of the problem that was built, and of refused runs
    /// Files that the study depends on: its own, its scene's and those that runs name.
    std::set<std::filesystem::path> named_files;

  private:
    /// Throws UserError if blanks have split a value, such as "one pass", in two.
    void
    refuse_split_values() const;

    /// Throws UserError if neither `there` nor any run has a column that the study requests.
    void
    check_columns(const std::vector<std::string> &there) const;

    std::set<std::string> refusals; ///< messages on runs whose values are not allowed
  };
} // namespace Exemplar

#endif
