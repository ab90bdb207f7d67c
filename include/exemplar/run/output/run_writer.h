// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_run_writer_h
#define exemplar_run_writer_h

#include <exemplar/run/output/checkpoint.h>
#include <exemplar/run/output/frame_output.h>
#include <exemplar/run/output/run_directory.h>
#include <exemplar/run/output/statistics_file.h>
#include <exemplar/run/problem/problem.h>
#include <exemplar/run/problem/space_error_estimator.h>
#include <exemplar/run/scene/scene_file.h>

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Writes everything that a run of a problem leaves on disk. All processes that share a body must
  /// call its functions: the root writes all but the others' pieces of frames, and what one throws all
  /// throw. With more than one thread, frames
  /// are written while the next step is computed; what begin(), add_step() and finish()
  /// throw may then be the error of an earlier frame. Checkpoints and what finish()
  /// writes wait for all frames before them.
  class RunWriter
  {
  public:
    /// Keeps references to all three. Throws UserError if the scene asks for a format that is
    /// not among `formats`.
    RunWriter(Problem                        &problem,
              const SceneFile                &scene,
              const std::vector<FrameFormat> &formats = frame_formats());

    /// Begin a new run: check and clear the directory, write the scene and the
    /// initial state. Throws UserError, with nothing written.
    void
    begin();

    /// Go on from the checkpoint in the directory, which sets the problem's state.
    /// Throws UserError, with nothing changed, if the scene is another one.
    void
    resume();

    /// Go on from the state of a step that is kept, or from the checkpoint if that is of this step,
    /// with this scene or another one of the same kind, mesh and steps of time. What was written of
    /// later steps is removed; before an edited scene goes on, the earlier one and its statistics are
    /// copied to original_N.prm, parameters_N.prm and statistics_N.csv. Throws UserError, with
    /// nothing changed, if that cannot be; returns what the user must know.
    std::vector<std::string>
    resume_from(unsigned int step);

    /// Write what follows a solve: the frame, the row of statistics, and a checkpoint
    /// when its time has come.
    void
    add_step(const SolveReport &report);

    /// Write final.msh, the animations, a checkpoint and the summary, with all warnings of the run.
    void
    finish(const std::string &status, const std::vector<std::string> &warnings = {});

    const RunTotals &
    get_totals() const
    {
      return totals;
    }

    /// Of the last step, if the scene asks for it and the step was made.
    const std::optional<SpaceError> &
    get_space_error() const
    {
      return space_error;
    }

  private:
    /// What the root does alone, while the directory is the one that it has taken.
    void
    at_root(const std::function<void()> &action) const;

    void
    write_original() const;

    /// All values in force, behind what says where the run went on with another scene.
    void
    write_parameters(const std::vector<SceneEdit> &edits) const;

    void
    write_rest_mesh() const;

    void
    write_final_pose() const;

    /// What is saved of the present state; whole at the root.
    Checkpoint
    present() const;

    /// After the root has taken the directory: notice in all processes if it is replaced.
    void
    watch_directory();

    /// Write a row of statistics.csv; of a failed step it is of no state.
    void
    write_row(StatisticsRow row, const std::optional<PhaseSeconds> &seconds, bool is_of_state);

    void
    save();

    /// Write the present step's frame, with the error in space if the scene asks for that.
    void
    write_frame();

    bool
    is_last_step() const;

    /// If it is asked for at the present step, find the error in space, unless it is known.
    void
    find_space_error();

    /// If states are kept and the present step has a frame.
    void
    keep_state() const;

    /// What all that go on do at last: frames, totals and clocks.
    void
    go_on_from(const Checkpoint &checkpoint);

    /// The file that holds the state of a step, and what it holds. Throws UserError unless it is of
    /// the run in the directory, and so is statistics.csv.
    std::filesystem::path
    load_state(unsigned int step, Checkpoint &checkpoint) const;

    /// The name of the file that holds the state of a step; empty if it is that of the checkpoint.
    std::filesystem::path
    find_state(unsigned int step, unsigned int last) const;

    /// The clock counts as evaluation what follows and no other part claims, such as moving the
    /// handles.
    void
    end_reading();

    /// Seconds by part since the last call.
    PhaseSeconds
    lap();

    Problem                                 &problem;
    const Exchange                          &exchange;
    const SceneFile                         &scene;
    Diagnostics                              diagnostics;
    RunDirectory                             directory;
    const std::map<std::string, std::string> input_digests; ///< SHA-256 of the files read
    std::optional<StatisticsFile>            statistics;
    RunTotals                                totals;
    std::uintmax_t accepted_bytes = 0; ///< of statistics.csv, without the row of a failed step
    unsigned int   earlier_factorizations = 0; ///< before a resume
    PhaseSeconds   last_lap{};
    std::chrono::steady_clock::time_point last_checkpoint;
    FrameOutput                           frames;
    SpaceErrorEstimator                   estimator;
    std::optional<SpaceError>             space_error; ///< of the present step
  };
} // namespace Exemplar

#endif
