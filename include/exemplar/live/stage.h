// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_stage_h
#define exemplar_live_stage_h

#include <exemplar/live/kept_inputs.h>
#include <exemplar/live/recording.h>
#include <exemplar/live/session_log.h>
#include <exemplar/live/stored_bytes.h>
#include <exemplar/run/inputs/body_inputs.h>
#include <exemplar/run/problem/session_player.h>

#include <memory>
#include <optional>

namespace Exemplar::Live
{
  /// A problem with all that was done to it, so that it can go back, and be played again. Files of the scene are read
  /// once, whatever becomes of them later.
  class Stage
  {
  public:
    /// `record_to`: a directory, or empty. Throws UserError for what is no dynamic scene, and what Recording refuses.
    /// Writes nothing.
    Stage(const SceneFile &scene, const std::filesystem::path &record_to, unsigned int n_threads);

    /// To be called once before all below: what is done is written down from now on. Returns the scene of an earlier
    /// recording in the same directory, under the name that it has from now on; an empty path if there was none.
    /// Throws UserError if there can be no recording.
    std::filesystem::path
    begin();

    const Problem &
    get_problem() const
    {
      return *problem;
    }

    /// For what the library computes from a state, without changing it.
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

    /// Null unless one is made.
    Recording *
    get_recording()
    {
      return recording ? &*recording : nullptr;
    }

    /// Do it before the next step, and note it. Throws UserError for what the problem refuses.
    void
    act(const Session &events);

    SolveReport
    advance();

    /// A step has failed: go on from its start, with nothing remembered.
    void
    forget();

    /// Keep this moment for go_back(). Only the newest ones are kept.
    void
    keep_moment();

    std::size_t
    n_moments() const
    {
      return moments.size();
    }

    /// Go back to the moment that was kept last; false if there is none.
    bool
    go_back();

    /// Go back to the beginning of the scene. What was recorded since then is kept under other names.
    void
    begin_anew();

    /// Write down what is not on disk yet.
    void
    save();

  private:
    /// Where go_back() leads.
    struct Moment
    {
      State       state;
      StoredBytes solver_memory;
      long        done; ///< size of what was done
    };

    void
    make_problem_of(BodyInputs body);

    void
    make_problem_anew();

    void
    begin_recording();

    CompleteScene   parameters; ///< of the scene, for this many threads
    MshFile         contents;   ///< of the mesh at the beginning; the same holds for the next two
    BodyFields      fields;
    UndividedInputs undivided;
    std::unique_ptr<Problem>       problem;
    std::unique_ptr<SessionPlayer> player;
    const double                   step_size;
    std::optional<Recording>       recording;
    std::optional<KeptInputs>      kept; ///< null unless there is a recording
    std::vector<DeclaredKey>       keys; ///< of the recorded scene
    std::optional<SessionLog>      done; ///< since the beginning
    std::vector<Moment>            moments;
  };
} // namespace Exemplar::Live

#endif
