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
    /// Throws UserError if a key is unknown, if the reference is refused, or if the parts of
    /// the reference (without one, of the first run whose values are allowed) cannot be
    /// built. A run whose values are refused is planned: its row will say so.
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
    std::vector<std::string>  warnings; ///< of the parts that were built
    /// The study, its scene and all files that its runs name.
    std::set<std::filesystem::path> named_files;
  };
} // namespace Exemplar

#endif
