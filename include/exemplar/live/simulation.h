// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_simulation_h
#define exemplar_live_simulation_h

#include <exemplar/live/hand.h>
#include <exemplar/live/mailbox.h>
#include <exemplar/live/obstacle_frames.h>
#include <exemplar/live/pace.h>
#include <exemplar/live/skin_frames.h>
#include <exemplar/live/stage.h>
#include <exemplar/live/told.h>

#include <functional>
#include <string>
#include <vector>

namespace Exemplar::Live
{
  /// The messages that a viewer gets first.
  struct Welcome
  {
    std::string        scene; ///< JSON, see doc/live.md
    std::string        state; ///< JSON, the newest
    std::vector<Bytes> binaries;
  };

  /// Functions by which the solver's thread sends to viewers; all may be called from any thread.
  struct Outbox
  {
    std::function<void(Bytes)>       frame;
    std::function<void(std::string)> text;    ///< JSON
    std::function<void(Welcome)>     welcome; ///< for all viewers: the scene is another one
    /// The welcome for later viewers, and the messages for present ones: the scene has other obstacles.
    std::function<void(Welcome, std::vector<Bytes>)> obstacles;
  };

  /// The simulation in its own thread: steps of one length at the pace of the clock, between which
  /// it does what viewers ask for. No step depends on the clock: each event is noted with the step
  /// before which it was done.
  class Simulation
  {
  public:
    /// `stage` and `mailbox` must outlive this. `up` is a unit vector.
    Simulation(Stage &stage, Mailbox &mailbox, Outbox outbox, const SpaceVector3 &up);

    Welcome
    welcome() const;

    /// What is drawn instead of the body's boundary, as SkinFrames::topology().
    const std::string &
    drawn_surface() const
    {
      return skin.topology();
    }

    /// Runs until the mailbox is stopped.
    void
    run();

  private:
    void
    obey(const Command &command);

    /// Carries out a command by which a hand acts on the body.
    void
    touch(const Command &command);

    /// Saves the present moment for Undo, together with `held`, if the disk has room.
    void
    keep_moment(const Hand::Held &held);

    void
    make_step();

    /// After a step that failed, before whose motions `before` was held: releases all pulls and stops handles that
    /// were dragged; after repeated failures, begins anew and pauses.
    void
    recover(const std::string &message, const Hand::Held &before);

    void
    undo();

    void
    begin_anew();

    void
    save_pose();

    /// Let what the body is now be one more example, and begin anew with it.
    void
    add_example();

    void
    show_frame();

    void
    choose_colour(const std::string &name);

    /// Tell viewers if the obstacles are others than they know.
    void
    show_obstacles();

    void
    show_state();

    void
    show_status();

    void
    tell(const std::string &type, const std::string &text) const;

    /// The field that a viewer chose, at the vertices; empty: none is chosen.
    Colours
    colours() const;

    /// Data shown beside the body.
    struct Shown
    {
      SolveReport   report;
      std::uint32_t n_frames = 0;
      std::uint32_t pointer  = 0; ///< sequence number of the newest pointer place used
    };

    Stage                  &stage;
    Mailbox                &mailbox;
    const Outbox            outbox;
    const SpaceVector3      up;
    const BodySurface       surface;
    const SkinFrames        skin;
    ObstacleFrames          obstacles;
    Hand                    hand;
    std::vector<Hand::Held> held_before; ///< one for each moment that the stage keeps
    Pace                    pace;
    Shown                   shown;
    Wish                    wish;
    bool                    state_is_new   = false; ///< whether viewers need a new state
    unsigned int            n_single_steps = 0;     ///< steps to make while paused
    unsigned int            n_failures     = 0;     ///< consecutive failed steps
  };
} // namespace Exemplar::Live

#endif
