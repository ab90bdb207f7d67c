// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_session_player_h
#define exemplar_session_player_h

#include <exemplar/potential/spring_term.h>
#include <exemplar/run/session/lasting_events.h>

#include <map>
#include <memory>
#include <string>

namespace Exemplar
{
  class Problem;

  /// Does to a problem what a hand did: while it is dragged, and when a recorded session is played
  /// again. Both do the same between the same steps, so that both end in the same bytes.
  ///
  /// | what | name | nodes | numbers |
  /// |---|---|---|---|
  /// | grab | of the spring | any | a share of the stiffness and an offset from the anchor [m] for each, anchor [m], stiffness [N/m] |
  /// | move | of the spring | | 3 of the anchor [m] |
  /// | release | of the spring | | |
  /// | hold | of the handle | ascending | displacements from rest, 3 a node [m] |
  /// | shift | of a handle that was held so | | displacement of all of it since then [m] |
  /// | let go | of the handle | | |
  /// | young, poisson, density, importance | | | 1, for all cells |
  /// | weights | | | one a weight: they are held; none: they are found again |
  /// | gravity | | | 3 [m/s^2] |
  /// | damping | | | mass damping [1/s], stiffness damping [s] |
  /// | forget | | | a step had failed: what the solver remembers counts no more |
  class SessionPlayer
  {
  public:
    /// Adds a term of springs to the problem, which must outlive this. Throws UserError for an interpolation, and where
    /// several processes share the body.
    explicit SessionPlayer(Problem &problem);

    /// Do it now. Throws UserError, with nothing changed, for what the problem refuses, and for an event that is none.
    void
    apply(const SessionEvent &event);

    /// From now on begin_step() does what this session of a file says. Throws as check_session().
    void
    play(Session recorded, std::string file);

    /// Do what was done before the problem's next step.
    void
    begin_step();

    /// The problem is about to go on from a state after this step: do all that was done until there.
    /// Throws UserError for a step before that.
    void
    catch_up(unsigned int step);

    /// The same with all that these events lead to. Throws as apply().
    void
    catch_up(const LastingEvents &events);

    /// Those that pull now.
    const Springs &
    get_springs() const
    {
      return *springs;
    }

  private:
    using Action = void (SessionPlayer::*)(const SessionEvent &);

    static const std::map<std::string, Action> actions;

    // actions
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
    void
    set_material(const SessionEvent &event);
    void
    set_importance(const SessionEvent &event);
    void
    hold_weights(const SessionEvent &event);
    void
    set_gravity(const SessionEvent &event);
    void
    set_damping(const SessionEvent &event);
    void
    forget(const SessionEvent &event);

    /// A handle's nodes when it was held [m], and how far all were shifted since then.
    struct Place
    {
      std::vector<dealii::Tensor<1, 3>> displacements;
      dealii::Tensor<1, 3>              shift;
    };

    Problem                                      &problem;
    const std::shared_ptr<Springs>                springs;
    std::map<std::string, std::shared_ptr<Place>> places; ///< by names of handles
    Session                                       recorded;
    std::string                                   file;         ///< of `recorded`, for messages
    std::size_t                                   n_played = 0; ///< of `recorded`
  };
} // namespace Exemplar

#endif
