// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/digest.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/run/resume_checks.h>

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

    void
    check_same_scene(const Checkpoint                         &checkpoint,
                     const SceneFile                          &scene,
                     const std::map<std::string, std::string> &input_digests,
                     const std::filesystem::path              &file)
    {
      const std::string failure = "Cannot resume from " + file.string() + ": ";
      const std::string remedy
          = " Change it back, or run the scene without --resume. Only Time/End "
            "and the section Output may change.";
      const std::string absent   = "(absent)";
      const auto        value_in = [&](const auto &values, const std::string &key)
      {
        const auto entry = values.find(key);
        return entry == values.end() ? absent : entry->second;
      };
      const auto now  = values_of(scene);
      auto       both = now;
      both.insert(checkpoint.parameters.begin(), checkpoint.parameters.end());
      for (const auto &entry : both)
      {
        const std::string &key    = entry.first;
        const std::string  before = value_in(checkpoint.parameters, key);
        const std::string  after  = value_in(now, key);
        if (before != after && !may_change(key))
          throw UserError(failure + key + " was '" + before + "' and is now '" + after + "'."
                          + remedy);
      }
      for (const auto &[input, digest] : input_digests)
        if (value_in(checkpoint.input_digests, input) != digest)
          throw UserError(failure + "the file " + input + " has changed since." + remedy);
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

    /// A name for messages, and the numbers of a state that it stands for.
    struct NamedNumbers
    {
      std::string   name;
      const double *first;
      std::size_t   size, expected; ///< how many there are, and how many the problem has
    };

    std::vector<NamedNumbers>
    numbers_of(const State &found, const State &initial)
    {
      const auto entry
          = [](const std::string &name, const auto &numbers, const std::size_t expected) {
              return NamedNumbers{ name, numbers.data(), numbers.size(), expected };
            };
      // a scheme of two steps has no step before at the start, others never have one
      const auto previous = [&](const Vector &numbers)
      { return numbers.size() == 0 ? 0 : initial.velocities.size(); };
      return {
        entry("positions", found.positions, initial.positions.size()),
        entry("velocities", found.velocities, initial.velocities.size()),
        entry("positions before", found.previous_positions, previous(found.previous_positions)),
        entry("velocities before", found.previous_velocities, previous(found.previous_velocities)),
        entry("weights", found.weights, initial.weights.size()),
        entry("multipliers", found.multipliers, initial.multipliers.size())
      };
    }

    void
    check_state(const State &found, const State &initial, const std::filesystem::path &file)
    {
      const std::string failure = "Cannot resume from " + file.string() + ": ";
      const std::string remedy  = ". Run the scene without --resume.";
      for (const NamedNumbers &numbers : numbers_of(found, initial))
      {
        if (numbers.size != numbers.expected)
          throw UserError(failure + "it holds " + std::to_string(numbers.size) + " numbers as "
                          + numbers.name + ", but the scene has " + std::to_string(numbers.expected)
                          + remedy);
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

  void
  check_resumable(const Checkpoint                         &checkpoint,
                  const SceneFile                          &scene,
                  const std::map<std::string, std::string> &input_digests,
                  const Problem                            &problem,
                  const std::filesystem::path              &file)
  {
    check_same_scene(checkpoint, scene, input_digests, file);
    check_step(checkpoint.state, scene, problem.time_axis, file);
    check_state(checkpoint.state, problem.state, file);
  }

  void
  check_statistics(const std::filesystem::path &file, const Checkpoint &checkpoint)
  {
    const std::string remedy = " Run the scene without --resume.";
    std::error_code   error;
    if (!std::filesystem::is_regular_file(file, error)
        || std::filesystem::file_size(file, error) < checkpoint.statistics_bytes)
      throw UserError(file.string() + " is missing or shorter than at the checkpoint." + remedy);
    if (sha256_of_begin(file, checkpoint.statistics_bytes) != checkpoint.statistics_digest)
      throw UserError(file.string() + " has changed since the checkpoint." + remedy);
  }
} // namespace Exemplar
