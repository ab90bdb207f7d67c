// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/digest.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/run/resume_checks.h>

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
                  const TimeAxis                           &time_axis,
                  const std::filesystem::path              &file)
  {
    check_same_scene(checkpoint, scene, input_digests, file);
    check_step(checkpoint.state, scene, time_axis, file);
  }
} // namespace Exemplar
