// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/digest.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/run/output/resume_checks.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace Exemplar
{
  namespace
  {
    bool
    may_change(const std::string &key)
    {
      return key == "Time/End" || key.compare(0, 7, "Output/") == 0;
    }

    const std::string absent = "(absent)";

    std::string
    value_in(const std::map<std::string, std::string> &values, const std::string &key)
    {
      const auto entry = values.find(key);
      return entry == values.end() ? absent : entry->second;
    }

    struct ChangedKey
    {
      std::string key, before, after;

      std::string
      text() const
      {
        return key + " was '" + before + "' and is now '" + after + "'.";
      }
    };

    /// Whether the edits of a state's run are those of this run up to the state's step.
    bool
    is_of_run(const Checkpoint &state, const RunTotals &run)
    {
      const std::vector<SceneEdit> &before = state.totals.edits, &all = run.edits;
      const auto                    same = [](const SceneEdit &a, const SceneEdit &b)
      { return a.step == b.step && a.scene == b.scene; };
      return state.totals.first_scene == run.first_scene && before.size() <= all.size()
             && std::equal(before.begin(), before.end(), all.begin(), same)
             && (before.size() == all.size() || all[before.size()].step >= state.state.step);
    }

    /// Changed keys, except those that any resumed run may change.
    std::vector<ChangedKey>
    changed_keys(const Checkpoint &checkpoint, const SceneFile &scene)
    {
      const auto now  = values_of(scene);
      auto       both = now;
      both.insert(checkpoint.parameters.begin(), checkpoint.parameters.end());
      std::vector<ChangedKey> changed;
      for (const auto &entry : both)
      {
        const std::string &key      = entry.first;
        const std::string  before   = value_in(checkpoint.parameters, key);
        const std::string  after    = value_in(now, key);
        const bool         is_unset = before == absent && after.empty(); // of a new region
        if (before != after && !is_unset && !may_change(key))
          changed.push_back({ key, before, after });
      }
      return changed;
    }

    std::vector<std::string>
    changed_files(const Checkpoint                         &checkpoint,
                  const std::map<std::string, std::string> &input_digests)
    {
      std::vector<std::string> files;
      for (const auto &[input, digest] : input_digests)
        if (value_in(checkpoint.input_digests, input) != digest)
          files.push_back(input);
      return files;
    }

    /// Whether a run cannot be resumed with this change, even as an edited scene.
    bool
    is_fixed(const ChangedKey &changed)
    {
      const std::string &key = changed.key;
      if (key == "Mesh/Surface") // may be added, but not changed
        return !changed.before.empty();
      return key == "Scene" || key == "Time/Step" || key == "Time/Increments"
             || key == "Model/Element" || key.compare(0, 5, "Mesh/") == 0;
    }

    /// A sentence on the first change that excludes resuming, even as an edited scene; empty if
    /// none.
    std::string
    fixed_change(const Checkpoint                         &checkpoint,
                 const SceneFile                          &scene,
                 const std::map<std::string, std::string> &input_digests)
    {
      for (const ChangedKey &changed : changed_keys(checkpoint, scene))
        if (is_fixed(changed))
          return changed.text();
      const auto            files = changed_files(checkpoint, input_digests);
      const MeshParameters &mesh  = scene.get_parameters().mesh;
      std::vector<std::pair<std::string, std::string>> fixed
          = { { "mesh ", mesh.file }, { "surface ", mesh.surface } };
      for (const std::string &file : mesh.files)
        fixed.emplace_back("mesh ", file);
      for (const std::string &file : mesh.carried)
        fixed.emplace_back("surface ", file);
      for (const auto &[what, name] : fixed)
        if (std::count(files.begin(), files.end(), name) > 0
            && checkpoint.input_digests.count(name) > 0)
          return "the " + (what + name) + " has changed since.";
      return "";
    }

    void
    check_same_scene(const Checkpoint                         &checkpoint,
                     const SceneFile                          &scene,
                     const std::map<std::string, std::string> &input_digests,
                     const std::filesystem::path              &file)
    {
      const std::string failure = "Cannot resume from " + file.string() + ": ";
      const std::string usual_remedy
          = " Change it back, or run the scene from its start, without --resume. Only Time/End and "
            "the section Output may change";
      if (const std::string what = fixed_change(checkpoint, scene, input_digests); !what.empty())
        throw UserError(failure + what + usual_remedy + ".");
      const std::string remedy
          = fmt::format("{}; to go on with another scene after step {}, say --resume-from {}.",
                        usual_remedy, checkpoint.state.step, checkpoint.state.step);
      for (const ChangedKey &changed : changed_keys(checkpoint, scene))
        throw UserError(failure + changed.text() + remedy);
      for (const std::string &input : changed_files(checkpoint, input_digests))
        throw UserError(failure + "the file " + input + " has changed since." + remedy);
    }

    void
    refuse_other_steps(const Checkpoint                         &checkpoint,
                       const SceneFile                          &scene,
                       const std::map<std::string, std::string> &input_digests,
                       const std::filesystem::path              &file)
    {
      if (const std::string what = fixed_change(checkpoint, scene, input_digests); !what.empty())
        throw UserError("Cannot go on from " + file.string() + ": " + what
                        + " The kind of scene, its mesh and element and its steps of time must "
                          "stay. Change it back, or run the scene from its start, without "
                          "--resume-from.");
    }

    void
    check_step(const State                 &state,
               const SceneFile             &scene,
               const TimeAxis              &axis,
               const std::filesystem::path &file)
    {
      if (state.step > axis.n_steps() || state.time != axis.time(state.step))
        throw UserError("Cannot resume from " + file.string() + ": it stands at t = "
                        + shortest_text(state.time) + ", which is no step of a run to Time/End = "
                        + shortest_text(scene.get_parameters().time.end)
                        + ". Choose a later end, or run the scene without --resume.");
    }

    /// Numbers of a state, with a name for messages.
    struct NamedNumbers
    {
      std::string   name;
      const double *first;
      std::size_t   size, expected; ///< how many there are, and how many there should be
    };

    std::vector<NamedNumbers>
    numbers_of(const State &found, const State &initial, const Mesh &mesh, const std::size_t n_dofs)
    {
      const auto entry
          = [](const std::string &name, const auto &numbers, const std::size_t expected) {
              return NamedNumbers{ name, numbers.data(), numbers.size(), expected };
            };
      // two-step schemes have no step before at the start, one-step schemes never
      const auto previous = [&](const Vector &numbers)
      { return numbers.size() == 0 || initial.velocities.size() == 0 ? 0 : n_dofs; };
      return {
        entry("positions", found.positions, n_dofs),
        entry("velocities", found.velocities, initial.velocities.size() == 0 ? 0 : n_dofs),
        entry("positions before", found.previous_positions, previous(found.previous_positions)),
        entry("velocities before", found.previous_velocities, previous(found.previous_velocities)),
        entry("weights", found.weights, initial.weights.size()),
        entry("weights before", found.previous_weights,
              found.previous_weights.empty() ? 0 : initial.weights.size()),
        entry("multipliers", found.multipliers, initial.multipliers.size()),
        entry("history", found.history,
              initial.history.size() / mesh.n_cells() * mesh.whole().n_cells)
      };
    }

    void
    check_state(const State &found, const Problem &problem, const std::filesystem::path &file)
    {
      const std::size_t n_dofs
          = 3 * problem.body.exchange().n_nodes(problem.body.fe_space.n_nodes());
      const std::string failure = "Cannot resume from " + file.string() + ": ";
      const std::string remedy  = ". Run the scene without --resume.";
      for (const NamedNumbers &numbers :
           numbers_of(found, problem.state, problem.body.mesh, n_dofs))
      {
        if (numbers.size != numbers.expected)
          throw UserError(fmt::format("{}it holds {} numbers as {}, but the scene has {}{}",
                                      failure, numbers.size, numbers.name, numbers.expected,
                                      remedy));
        if (!std::all_of(numbers.first, numbers.first + numbers.size,
                         [](const double x) { return std::isfinite(x); }))
          throw UserError(failure + "its " + numbers.name + " are not all finite" + remedy);
      }
    }
  } // namespace

  std::map<std::string, std::string>
  values_of(const SceneFile &scene)
  {
    std::map<std::string, std::string> values;
    for (const DeclaredKey &key : scene.get_keys())
      values[key.path()] = key.value;
    return values;
  }

  std::map<std::string, std::string>
  digests_of(const SceneFile &scene)
  {
    std::map<std::string, std::string> digests;
    for (const std::filesystem::path &file : scene.input_files())
      digests[file.string()] = sha256(file);
    return digests;
  }

  std::string
  digest_of(const SceneFile &scene, const std::map<std::string, std::string> &input_digests)
  {
    std::string text;
    for (const auto &[key, value] : values_of(scene))
      if (!may_change(key))
        text += key + "=" + value + '\n';
    for (const auto &[file, digest] : input_digests)
      text += file + " " + digest + '\n';
    return sha256_of_text(text);
  }

  void
  check_kept_state(const Checkpoint            &state,
                   const std::filesystem::path &file,
                   const unsigned int           step,
                   const Checkpoint            &last,
                   const std::filesystem::path &statistics)
  {
    const std::string remedy = " Take another step, or run the scene from its start, without "
                               "--resume-from.";
    if (state.state.step != step)
      throw UserError(fmt::format("{} is not the state of step {}, but of step {}.{}",
                                  file.string(), step, state.state.step, remedy));
    if (!is_of_run(state, last.totals))
      throw UserError(file.string() + " is the state of another run than this directory's."
                      + remedy);
    check_statistics(statistics, state.state.step > last.state.step ? state : last);
  }

  void
  check_resumable(const Checkpoint                         &checkpoint,
                  const SceneFile                          &scene,
                  const std::map<std::string, std::string> &input_digests,
                  const Problem                            &problem,
                  const std::filesystem::path              &file)
  {
    check_same_scene(checkpoint, scene, input_digests, file);
    check_step(checkpoint.state, scene, problem.time_axis, file);
    check_state(checkpoint.state, problem, file);
  }

  EditCheck
  check_editable(Checkpoint                               &checkpoint,
                 const SceneFile                          &scene,
                 const std::map<std::string, std::string> &input_digests,
                 const Problem                            &problem,
                 const std::filesystem::path              &file)
  {
    refuse_other_steps(checkpoint, scene, input_digests, file);
    check_step(checkpoint.state, scene, problem.time_axis, file);
    const std::vector<ChangedKey> changed = changed_keys(checkpoint, scene);
    EditCheck                     result;
    result.is_edited = !changed.empty() || !changed_files(checkpoint, input_digests).empty();
    State &state     = checkpoint.state;
    bool   rule      = state.weights.size() != problem.state.weights.size();
    for (const ChangedKey &one : changed)
    {
      rule = rule || one.key == "Examples/Weights";
      if (one.key.compare(0, 8, "Initial/") == 0)
        result.notes.push_back(one.text() + " It acts at the start of a run alone, so not here.");
      if (one.key == "Time/Scheme") // useless to the other scheme
      {
        state.previous_positions.reinit(0);
        state.previous_velocities.reinit(0);
        state.previous_weights.clear();
        state.previous_step = 0.;
      }
    }
    if (result.is_edited)
      checkpoint.solver_memory.clear(); // belongs to another potential
    if (rule && state.weights != problem.state.weights)
    {
      result.notes.push_back(fmt::format("The example weights are others than those of step {}, so "
                                         "they begin anew, with those that the scene starts with.",
                                         state.step));
      state.weights = problem.state.weights;
      if (!state.previous_weights.empty())
        state.previous_weights = state.weights;
      state.multipliers = problem.state.multipliers;
    }
    check_state(state, problem, file);
    return result;
  }

  void
  check_statistics(const std::filesystem::path &file, const Checkpoint &checkpoint)
  {
    const std::string remedy = " Run the scene from its start, without --resume and --resume-from.";
    std::error_code   error;
    if (!std::filesystem::is_regular_file(file, error)
        || std::filesystem::file_size(file, error) < checkpoint.statistics_bytes)
      throw UserError(file.string() + " is missing or shorter than at the checkpoint." + remedy);
    if (sha256_of_begin(file, checkpoint.statistics_bytes) != checkpoint.statistics_digest)
      throw UserError(file.string() + " has changed since the checkpoint." + remedy);
  }
} // namespace Exemplar
