// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_stage_h
#define exemplar_live_stage_h

#include <exemplar/live/recording.h>
#include <exemplar/live/session_log.h>
#include <exemplar/run/inputs/body_inputs.h>
#include <exemplar/run/problem/session_player.h>

#include <memory>
#include <optional>
#include <string>

namespace Exemplar::Live
{
  /// Bytes that are seldom needed again, in an unnamed file on disk, which lives as long as this.
  class StoredBytes
  {
  public:
    /// Throws std::system_error if they cannot be written.
    explicit StoredBytes(const std::string &bytes);

    /// Throws std::runtime_error if they cannot be read.
    std::string
    get() const;

  private:
    CFile       file;
    std::size_t size;
  };

  /// A problem with the log of all events, so that it can go back, and be played again. Files of
  /// the scene are read once, whatever becomes of them later.
  class Stage
  {
  public:
    /// `record_to` is a directory, or empty. Throws UserError for a scene that is not dynamic, and
    /// where Recording does. Writes nothing.
    Stage(const SceneFile &scene, const std::filesystem::path &record_to, unsigned int n_threads);

    /// Begins the log; to be called once before all functions below. Returns the scene of an
    /// earlier recording in the same directory, under the name that it has from now on; an empty
    /// path if there was none. Throws UserError if there can be no recording.
    std::filesystem::path
    begin();

    const Problem &
    get_problem() const
    {
      return *problem;
    }

    /// The problem, for functions of the library that leave its state unchanged.
    Problem &
    get_problem()
    {
      return *problem;
    }

    /// The length of all steps [s].
    double
    get_step_size() const
    {
      return step_size;
    }

    /// The recording; null: none is made.
    Recording *
    get_recording()
    {
      return recording ? &*recording : nullptr;
    }

    /// Apply events before the next step, and log them. Throws UserError for events that the
    /// problem refuses.
    void
    act(const Session &events);

    SolveReport
    advance();

    /// After a step that failed: continue from its start, without the solver's memory.
    void
    forget();

    /// Save this moment for go_back(). Only the newest moments are kept.
    void
    keep_moment();

    std::size_t
    n_moments() const
    {
      return moments.size();
    }

    /// Go back to the last saved moment; false if there is none.
    bool
    go_back();

    /// Go back to the beginning of the scene. The recording since then is kept under other names.
    void
    begin_anew();

    /// Let the positions be one more example, and go back to the beginning of the scene that has it. The recording since
    /// then is kept under other names. Returns the example's name, the file of the pose if there is a recording. Throws
    /// UserError, with the body unchanged, for a scene that takes no more examples.
    std::string
    add_example();

    /// Write to disk all that is not there yet.
    void
    save();

  private:
    /// A moment to which go_back() leads.
    struct Moment
    {
      State       state;
      StoredBytes solver_memory;
      long        done; ///< size of the log [bytes]
    };

    void
    make_problem_of(BodyInputs body);

    void
    make_problem_anew();

    void
    begin_recording();

    CompleteScene                  parameters; ///< parameters of the scene, for this many threads
    MshFile                        contents;   ///< mesh at the beginning, as are the next two
    BodyFields                     fields;
    UndividedInputs                undivided;
    std::unique_ptr<Problem>       problem;
    std::unique_ptr<SessionPlayer> player;
    const double                   step_size;
    std::optional<Recording>       recording;
    std::optional<KeptInputs>      kept; ///< null unless there is a recording
    std::vector<DeclaredKey>       keys; ///< keys of the recorded scene
    std::optional<SessionLog>      done; ///< log since the beginning
    std::vector<Moment>            moments;
  };
} // namespace Exemplar::Live

#endif
