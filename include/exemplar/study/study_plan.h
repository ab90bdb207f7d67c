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
    /// Throws UserError if a key is unknown, if the reference is refused, if the parts of
    /// the reference (without one, of the first run whose values are allowed) cannot be
    /// built, or if no run has a column that is asked for. A run whose values are refused is
    /// planned: a warning, and its row, will say so.
    explicit StudyPlan(const Study &study);

    /// How many runs are to be made in all, repeats included.
    unsigned int
    n_repeats() const;

    /// Of all runs and the reference.
    std::vector<std::string>
    names() const;

    const Study              &study;
    const std::string         scene_text;
    std::optional<PlannedRun> reference;
    std::vector<PlannedRun>   runs;
    std::vector<std::string>  warnings; ///< of the parts that were built, and of refused runs
    /// The study, its scene and all files that its runs name.
    std::set<std::filesystem::path> named_files;

  private:
    /// Throws UserError where blanks have divided a value of a key, such as "one pass".
    void
    refuse_split_values() const;

    /// Throws UserError if neither `there` nor any run has a column that the study asks for.
    void
    check_columns(const std::vector<std::string> &there) const;

    std::set<std::string> refusals; ///< of runs whose values are not allowed
  };
} // namespace Exemplar

#endif
