// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/agreement.h>
#include <exemplar/base/errors.h>
#include <exemplar/run/output/resume_checks.h>
#include <exemplar/run/output/run_writer.h>

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace Exemplar
{
  namespace fs = std::filesystem;

  namespace
  {
    /// Whether the checkpoint's step has a frame only because the run ended there.
    bool
    is_only_last_frame(const Checkpoint &checkpoint)
    {
      const auto every = checkpoint.parameters.find("Output/Every");
      return every != checkpoint.parameters.end()
             && checkpoint.state.step % std::max(1, std::stoi(every->second)) != 0;
    }
  } // namespace

  void
  RunWriter::resume()
  {
    Checkpoint checkpoint;
    at_root(
        [&]
        {
          directory.take_for_resume(scene.named_files());
          checkpoint = load_checkpoint(directory.get_files().checkpoint());
          check_resumable(checkpoint, scene, input_digests, problem,
                          directory.get_files().checkpoint());
          check_statistics(directory.get_files().statistics(), checkpoint);
        });
    directory.watch();
    share(exchange, checkpoint);
    restore(checkpoint, directory.get_files().checkpoint(),
            problem); // last, as it may throw
    {
      StepClock::Scope scope(problem.clock, Phase::output);
      at_root(
          [&]
          {
            statistics.emplace(directory.get_files().statistics(), checkpoint.statistics_bytes);
            write_original();
            write_rest_mesh();
            write_parameters(checkpoint.totals.edits);
            directory.remove_shapes(); // Output/Formats may have changed
            frames.write_shapes();
          });
    }
    accepted_bytes = checkpoint.statistics_bytes;
    diagnostics.resume(checkpoint.work);
    account.take_over(checkpoint.totals);
    go_on_from(checkpoint);
  }

  fs::path
  RunWriter::find_state(const unsigned int step, const unsigned int last) const
  {
    const fs::path kept = directory.get_files().state(step);
    if (fs::exists(kept))
      return kept;
    if (last == step)
      return directory.get_files().checkpoint();
    std::string steps;
    for (const unsigned int other : directory.kept_states())
      if (other != last)
        steps += fmt::format("{}, ", other);
    throw UserError(fmt::format(
        "There is no state of step {} in {}. There are those of: {}{}. Choose one of them, or run "
        "the scene from its start with Output/Keep states = true, which keeps one for each frame.",
        step, directory.get_path().string(), steps, last));
  }

  fs::path
  RunWriter::load_state(const unsigned int step, Checkpoint &checkpoint) const
  {
    // the checkpoint tells to which run the states belong
    if (!fs::exists(directory.get_files().checkpoint()))
      throw UserError(
          directory.get_path().string()
          + " holds no checkpoint of a run to go on with. Run the scene from its start.");
    const Checkpoint last = load_checkpoint(directory.get_files().checkpoint());
    const fs::path   file = find_state(step, last.state.step);
    checkpoint            = load_checkpoint(file);
    check_kept_state(checkpoint, file, step, last, directory.get_files().statistics());
    return file;
  }

  std::vector<std::string>
  RunWriter::resume_from(const unsigned int step)
  {
    Checkpoint checkpoint;
    EditCheck  check;
    fs::path   file;
    at_root(
        [&]
        {
          directory.take_for_resume(scene.named_files());
          file  = load_state(step, checkpoint);
          check = check_editable(checkpoint, scene, input_digests, problem, file);
        });
    directory.watch();
    share(exchange, checkpoint);
    restore(checkpoint, file, problem);
    {
      StepClock::Scope scope(problem.clock, Phase::output);
      diagnostics.resume(checkpoint.work);
      StatisticsRow row = diagnostics.row(problem.state, SolveReport());
      Diagnostics::append_seconds(row, {});
      at_root(
          [&]
          {
            if (check.is_edited)
              checkpoint.totals.edits.push_back(
                  { step, directory.keep_earlier_scene(), digest_of(scene, input_digests) });
            accepted_bytes
                = StatisticsFile::keep_rows(directory.get_files().statistics(), step, row);
          });
      account.take_over(checkpoint.totals);
      save(); // a crash from now on can be resumed
      at_root(
          [&]
          {
            statistics.emplace(directory.get_files().statistics(), accepted_bytes);
            write_original();
            write_rest_mesh();
            write_parameters(checkpoint.totals.edits);
            directory.remove_shapes();
            directory.remove_animations();
            frames.write_shapes();
            fs::remove(directory.get_files().final_pose());
            fs::remove(directory.get_files().summary());
          });
    }
    go_on_from(checkpoint);
    return check.notes;
  }

  void
  RunWriter::go_on_from(const Checkpoint &checkpoint)
  {
    at_root(
        [&]
        {
          directory.remove_frames_after(checkpoint.state.step);
          if (is_only_last_frame(checkpoint) && !frames.is_due(checkpoint.state.step))
            frames.remove(checkpoint.state.step);
        });
    if (frames.is_due(checkpoint.state.step) && frames.is_missing()) // removed by a resume
      write_frame();
    account.begin_steps();
  }
} // namespace Exemplar
