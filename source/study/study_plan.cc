// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/problem.h>
#include <exemplar/run/scene_file.h>
#include <exemplar/study/study_plan.h>
#include <exemplar/study/study_table.h>

#include <memory>

namespace Exemplar
{
  namespace
  {
    /// The scene of a run, or null where its values are refused.
    std::unique_ptr<const SceneFile>
    scene_of(const std::vector<Assignment> &assignments,
             const Study                   &study,
             const std::string             &scene_text)
    {
      try
      {
        return std::make_unique<const SceneFile>(study.scene, scene_text, assignments);
      }
      catch (const UnknownKey &)
      {
        throw;
      }
      catch (const UserError &)
      {
        return nullptr;
      }
    }

    /// Whether a run can be built, with what warnings; why not is in `refusal`, if nothing is
    /// there yet.
    bool
    can_be_built(const SceneFile &scene, std::vector<std::string> &warnings, std::string &refusal)
    {
      try
      {
        warnings = make_problem(scene.get_parameters())->warnings();
        return true;
      }
      catch (const UserError &error)
      {
        if (refusal.empty())
          refusal = error.what();
        return false;
      }
    }
  } // namespace

  StudyPlan::StudyPlan(const Study &study)
      : study(study), scene_text(read_prm(study.scene)), named_files{ study.file, study.scene }
  {
    check_extra_columns(study);
    read_assignments(scene_text, study.scene.string()); // its syntax concerns all runs
    RunNames    names(study, scene_text);
    bool        parts_are_checked = false;
    std::string refusal;
    const auto  plan = [&](const std::vector<unsigned int> &choice, const auto &assignments)
    {
      const auto scene = scene_of(assignments, study, scene_text);
      parts_are_checked
          = parts_are_checked || (scene != nullptr && can_be_built(*scene, warnings, refusal));
      if (scene != nullptr)
        for (const auto &file : scene->named_files())
          named_files.insert(file);
      using Files = std::vector<std::filesystem::path>;
      return PlannedRun{ names.name(assignments, scene != nullptr ? scene->input_files() : Files()),
                         choice, assignments };
    };
    if (!study.reference.empty())
    {
      const auto assignments = study.reference_assignments();
      SceneFile(study.scene, scene_text, assignments); // throws if it is refused
      reference = plan({}, assignments);
      if (!parts_are_checked)
        throw UserError(refusal);
    }
    for (const auto &choice : study.choices())
      runs.push_back(plan(choice, study.assignments(choice)));
    if (parts_are_checked)
      return;
    SceneFile(study.scene, scene_text, runs.at(0).assignments); // throws if that is why
    throw UserError(refusal);
  }

  unsigned int
  StudyPlan::n_repeats() const
  {
    return static_cast<unsigned int>(runs.size()) * study.repeats + (reference ? 1 : 0);
  }

  std::vector<std::string>
  StudyPlan::names() const
  {
    std::vector<std::string> all;
    for (const PlannedRun &run : runs)
      all.push_back(run.name);
    if (reference)
      all.push_back(reference->name);
    return all;
  }
} // namespace Exemplar
