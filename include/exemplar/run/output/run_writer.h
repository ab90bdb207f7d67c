// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_run_writer_h
#define exemplar_run_writer_h

#include <exemplar/run/output/checkpoint.h>
#include <exemplar/run/output/frame_output.h>
#include <exemplar/run/output/last_space_error.h>
#include <exemplar/run/output/run_account.h>
#include <exemplar/run/output/run_directory.h>
#include <exemplar/run/output/statistics_file.h>
#include <exemplar/run/problem/problem.h>
#include <exemplar/run/scene/scene_file.h>

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Writes all files of a run. All processes that share a body must call its functions: the root
  /// writes all files but the others' pieces of frames, and exceptions are thrown by all. With more
  /// than one thread, frames are written while the next step is computed; begin(), add_step() and
  /// finish() may then throw the error of an earlier frame. Checkpoints and the files of finish()
  /// are written after all earlier frames.
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

    /// Continue from the checkpoint in the directory, which sets the problem's state. Throws
    /// UserError, with nothing changed, if the scene is another one.
    void
    resume();

    /// Continue from the kept state of a step, or from the checkpoint if it is of this step, with
    /// this scene or another one of the same kind, mesh and time steps. Files of later steps are
    /// removed; if the scene was edited, the earlier one and its statistics are first copied to
    /// original_N.prm, parameters_N.prm and statistics_N.csv. Throws UserError, with nothing
    /// changed, if that is impossible; returns notes for the user.
    std::vector<std::string>
    resume_from(unsigned int step);

    /// Write the frame and the row of statistics after a step, and a checkpoint when it is due.
    void
    add_step(const SolveReport &report);

    /// Write final.msh, the animations, a checkpoint and the summary, with all warnings of the run.
    void
    finish(const std::string &status, const std::vector<std::string> &warnings = {});

    const RunTotals &
    get_totals() const
    {
      return account.get_totals();
    }

    /// Error in space of the last step, if the scene asks for it and the step was made.
    const std::optional<SpaceError> &
    get_space_error() const
    {
      return space_error.get();
    }

  private:
    /// Run an action on the root alone, in its locked directory.
    void
    at_root(const std::function<void()> &action) const;

    void
    write_original() const;

    /// Write all values in force, after comments on the edits of the scene.
    void
    write_parameters(const std::vector<SceneEdit> &edits) const;

    void
    write_rest_mesh() const;

    /// SHA-256 of the mesh file; of several, of the lines of theirs.
    std::string
    mesh_digest() const;

    void
    write_final_pose() const;

    /// The checkpoint of the present state; complete on the root.
    Checkpoint
    present() const;

    /// Write a row of statistics.csv; `is_of_state` is false for a failed step.
    void
    write_row(StatisticsRow row, const std::optional<PhaseSeconds> &seconds, bool is_of_state);

    void
    save();

    /// Write the present step's frame, with the error in space if the scene asks for that.
    void
    write_frame();

    /// Keep the state if the scene keeps states and the present step has a frame.
    void
    keep_state() const;

    /// The last part of resume() and resume_from(): frames and clocks.
    void
    go_on_from(const Checkpoint &checkpoint);

    /// Load the state of a step; returns the file's name. Throws UserError unless it and
    /// statistics.csv are of the run in the directory.
    std::filesystem::path
    load_state(unsigned int step, Checkpoint &checkpoint) const;

    /// The name of the file of a step's kept state; empty if it is the checkpoint.
    std::filesystem::path
    find_state(unsigned int step, unsigned int last) const;

    Problem                                 &problem;
    const Exchange                          &exchange;
    const SceneFile                         &scene;
    Diagnostics                              diagnostics;
    RunDirectory                             directory;
    const std::map<std::string, std::string> input_digests; ///< SHA-256 of the files read
    std::optional<StatisticsFile>            statistics;
    std::uintmax_t accepted_bytes = 0; ///< of statistics.csv, without the row of a failed step
    RunAccount     account;
    std::chrono::steady_clock::time_point last_checkpoint;
    FrameOutput                           frames;
    LastSpaceError                        space_error;
  };
} // namespace Exemplar

#endif
