// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/message_text.h>
#include <exemplar/base/nearest_word.h>
#include <exemplar/base/number_text.h>
#include <exemplar/run/output/diagnostics.h>
#include <exemplar/run/problem/problem.h>
#include <exemplar/run/scene/scene_file.h>
#include <exemplar/study/study_plan.h>
#include <exemplar/study/study_table.h>

#include <deal.II/base/bounding_box.h>

#include <algorithm>
#include <memory>

namespace Exemplar
{
  namespace
  {
    /// The scene of a run; null if its values are refused, with the message in `refusal`.
    std::unique_ptr<const SceneFile>
    scene_of(const std::vector<Assignment> &assignments,
             const Study                   &study,
             const std::string             &scene_text,
             std::string                   &refusal)
    {
      try
      {
        return std::make_unique<const SceneFile>(study.scene, scene_text, assignments);
      }
      catch (const UnknownKey &)
      {
        throw;
      }
      catch (const UserError &error)
      {
        refusal = error.what();
        return nullptr;
      }
    }

    std::vector<std::string>
    columns_of(const Problem &problem)
    {
      StatisticsRow row = Diagnostics(problem).row(problem.state, SolveReport());
      Diagnostics::append_seconds(row, {});
      std::vector<std::string> columns;
      for (const StatisticsCell &cell : row)
        columns.push_back(cell.column);
      return columns;
    }

    /// Warnings of a probe outside the body's bounding box, perhaps in another unit.
    std::vector<std::string>
    warnings_of_probe(const Study &study, const std::vector<dealii::Point<3>> &nodes)
    {
      if (!study.probe)
        return {};
      const dealii::BoundingBox<3> box(nodes);
      const auto &[lowest, highest] = box.get_boundary_points();
      dealii::Point<3> in_box, nearest = nodes[0];
      for (unsigned int c = 0; c < 3; ++c)
        in_box[c] = std::clamp((*study.probe)[c], lowest[c], highest[c]);
      for (const dealii::Point<3> &node : nodes)
        if (node.distance_square(*study.probe) < nearest.distance_square(*study.probe))
          nearest = node;
      const double distance = in_box.distance(*study.probe);
      if (!(distance > 0.01 * lowest.distance(highest)))
        return {};
      return { study.probe_place + " lies " + short_text(distance)
               + " m outside the box around the body: the node nearest to it is taken, at "
               + short_text(nearest[0]) + ", " + short_text(nearest[1]) + ", "
               + short_text(nearest[2]) + ". Rest positions are in metres." };
    }

    /// Data of a run whose problem could be built.
    struct BuiltRun
    {
      std::vector<std::string> warnings, columns;
    };

    /// Whether the problem of a run can be built; if not, `refusal` gets the message unless it has
    /// one.
    bool
    can_be_built(const Study &study, const SceneFile &scene, BuiltRun &built, std::string &refusal)
    {
      try
      {
        const auto problem = make_problem(scene.get_parameters());
        built              = { problem->warnings(), columns_of(*problem) };
        for (const std::string &warning : warnings_of_probe(study, problem->body.mesh.get_nodes()))
          built.warnings.push_back(warning);
        return true;
      }
      catch (const UserError &error)
      {
        if (refusal.empty())
          refusal = error.what();
        return false;
      }
    }

    /// The columns among `asked` that a run does not have.
    std::vector<std::string>
    missing_columns(std::vector<std::string> asked, const std::vector<std::string> &there)
    {
      asked.erase(std::remove_if(asked.begin(), asked.end(),
                                 [&](const std::string &column)
                                 { return std::count(there.begin(), there.end(), column) > 0; }),
                  asked.end());
      return asked;
    }

    std::string
    text_of_scene(const Study &study)
    {
      try
      {
        return read_prm(study.scene);
      }
      catch (const UserError &error)
      {
        throw UserError(study.scene_place + ": " + error.what());
      }
    }
  } // namespace

  StudyPlan::StudyPlan(const Study &study)
      : study(study), scene_text(text_of_scene(study)), named_files{ study.file, study.scene }
  {
    check_extra_columns(study);
    read_assignments(scene_text, study.scene.string()); // its syntax errors concern all runs
    refuse_split_values();
    RunNames    names(study, scene_text);
    bool        parts_are_checked = false;
    BuiltRun    built;
    std::string refusal;
    const auto  plan = [&](const std::vector<unsigned int> &choice, const auto &assignments)
    {
      std::string why;
      const auto  scene = scene_of(assignments, study, scene_text, why);
      if (scene == nullptr)
        refusals.insert(why);
      parts_are_checked
          = parts_are_checked || (scene != nullptr && can_be_built(study, *scene, built, refusal));
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
      SceneFile(study.scene, scene_text, assignments); // throws if values are refused
      reference = plan({}, assignments);
      if (!parts_are_checked)
        throw UserError(refusal);
    }
    for (const auto &choice : study.choices())
      runs.push_back(plan(choice, study.assignments(choice)));
    if (!parts_are_checked)
    {
      SceneFile(study.scene, scene_text, runs.at(0).assignments); // throws if that is the cause
      throw UserError(refusal);
    }
    warnings = built.warnings;
    for (const std::string &why : refusals)
      warnings.push_back("Runs will be refused, as their rows will say: " + why);
    check_columns(built.columns);
  }

  void
  StudyPlan::refuse_split_values() const
  {
    const auto is_allowed = [&](const StudyAxis &axis, const std::string &value)
    {
      std::vector<Assignment> assignments = study.assignments({});
      assignments.push_back(parse_assignment(axis.keys[0] + "=", study.vary_place));
      assignments.back().value = value;
      try
      {
        SceneFile(study.scene, scene_text, assignments);
        return true;
      }
      catch (const UserError &) // it may need keys of other axes, too
      {
        return false;
      }
    };
    for (const StudyAxis &axis : study.axes)
      for (std::size_t i = 1; axis.keys.size() == 1 && i < axis.values.size(); ++i)
      {
        const std::string &first = axis.values[i - 1][0], both = first + " " + axis.values[i][0];
        if (!is_allowed(axis, first) && is_allowed(axis, both))
          throw UserError(study.vary_place + ": " + axis.name() + " has no value '" + first
                          + "', but '" + both + "'. Values with blanks are separated by commas: "
                          + axis.name() + ": " + both + ", ...");
      }
  }

  void
  StudyPlan::check_columns(const std::vector<std::string> &there) const
  {
    std::vector<std::string> missing = missing_columns(study.columns, there);
    for (std::size_t i = 0; i < runs.size() && !missing.empty(); ++i)
    {
      BuiltRun    built;
      std::string refusal;
      const auto  scene = scene_of(runs[i].assignments, study, scene_text, refusal);
      if (scene != nullptr && can_be_built(study, *scene, built, refusal))
        missing = missing_columns(std::move(missing), built.columns);
    }
    if (missing.empty())
      return;
    const std::string near = nearest_word(missing[0], there);
    throw UserError(
        study.columns_place + ": no run has the column '" + missing[0] + "'. "
        + (near.empty() ? "There are: " + joined(there) + "." : "Did you mean '" + near + "'?"));
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
