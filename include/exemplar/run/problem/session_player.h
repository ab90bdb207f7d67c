// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_session_player_h
#define exemplar_session_player_h

#include <exemplar/potential/spring_term.h>
#include <exemplar/run/session/session.h>

#include <map>
#include <memory>
#include <string>

namespace Exemplar
{
  class Problem;

  /// Applies interactive events to a problem, both live and when a recorded session is replayed.
  /// Both act between the same steps, so that both end in the same bytes.
  ///
  /// | what | name | nodes | numbers |
  /// |---|---|---|---|
  /// | grab | of the spring | any | a share of the stiffness and an offset from the anchor [m] for each, anchor [m], stiffness [N/m] |
  /// | move | of the spring | | 3 of the anchor [m] |
  /// | release | of the spring | | |
  /// | hold | of the handle | ascending, of a shell with the slopes that it holds | displacements from rest, 3 a node [m] |
  /// | shift | of a handle that was held so | | displacement of all of it since then [m] |
  /// | let go | of the handle | | |
  /// | young, poisson, density, importance | | | 1, for all cells |
  /// | ball | of the obstacle | | middle, radius [m], friction |
  /// | block | of the obstacle | | two opposite corners [m], friction |
  /// | carry | of any obstacle | | its displacement at the end of the step [m] |
  /// | take away | of any obstacle | | |
  /// | energy | a value of Examples/Energy | | |
  /// | weights | | | one a weight: they are held; none: they are unknown again |
  /// | gravity | | | 3 [m/s^2] |
  /// | damping | | | mass damping [1/s], stiffness damping [s] |
  /// | forget | | | a step had failed: the solver's memory is cleared |
  class SessionPlayer
  {
  public:
    /// Adds a term of springs to the problem, which must outlive this. Throws UserError for an
    /// interpolation, and if several processes share the body.
    explicit SessionPlayer(Problem &problem);

    /// Apply an event now. Throws UserError, with nothing changed, for invalid events and those
    /// that the problem refuses.
    void
    apply(const SessionEvent &event);

    /// Let begin_step() replay this session, read from `file`. Throws as check_session().
    void
    play(Session recorded, std::string file);

    /// Apply the recorded events before the problem's next step.
    void
    begin_step();

    /// Apply the recorded events up to this step, after which the problem is to be resumed. Throws
    /// UserError for a step before those applied.
    void
    catch_up(unsigned int step);

    /// Apply all of these events. Throws as apply().
    void
    catch_up(const LastingEvents &events);

    /// The springs that pull at present.
    const Springs &
    get_springs() const
    {
      return *springs;
    }

  private:
    using Action = void (SessionPlayer::*)(const SessionEvent &);

    /// On springs and handles.
    static const std::map<std::string, Action> actions;

    void
    grab(const SessionEvent &event);
    void
    move(const SessionEvent &event);
    void
    release(const SessionEvent &event);
    void
    hold(const SessionEvent &event);
    void
    shift(const SessionEvent &event);
    void
    let_go(const SessionEvent &event);

    /// Displacements of a handle's nodes when it was held [m], and the shift of all since then.
    struct Place
    {
      std::vector<dealii::Tensor<1, 3>> displacements;
      dealii::Tensor<1, 3>              shift;
    };

    Problem                                      &problem;
    const std::shared_ptr<Springs>                springs;
    std::map<std::string, std::shared_ptr<Place>> places; ///< by names of handles
    Session                                       recorded;
    std::string file;         ///< name of the session's file, for messages
    std::size_t n_played = 0; ///< number of events applied
  };
} // namespace Exemplar

#endif
