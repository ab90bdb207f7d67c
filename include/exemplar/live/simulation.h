// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_simulation_h
#define exemplar_live_simulation_h

#include <exemplar/live/hand.h>
#include <exemplar/live/mailbox.h>
#include <exemplar/live/pace.h>
#include <exemplar/live/stage.h>
#include <exemplar/live/told.h>

#include <functional>
#include <string>
#include <vector>

namespace Exemplar::Live
{
  /// Where the solver's thread leaves what viewers get; both may be called from any thread.
  struct Outbox
  {
    std::function<void(Bytes)>       frame;
    std::function<void(std::string)> text; ///< JSON
  };

  /// What a viewer gets first.
  struct Welcome
  {
    std::string        scene; ///< JSON: what doc/live.md calls so
    std::string        state; ///< the same, and the newest
    std::vector<Bytes> binaries;
  };

  /// The body in its own thread: steps of one length at the pace of the clock, between which it does what
  /// viewers ask for. No step depends on the clock: what was asked for is noted with the step before
  /// which it was done.
  class Simulation
  {
  public:
    /// Both must outlive it.
    Simulation(Stage &stage, Mailbox &mailbox, Outbox outbox);

    Welcome
    welcome() const;

    /// Until the mailbox is stopped.
    void
    run();

  private:
    void
    obey(const Command &command);

    /// The same for what a hand does to the body.
    void
    touch(const Command &command);

    /// For Undo, if it can be kept, with what is held at present.
    void
    keep_moment(const Hand::Held &held);

    void
    make_step();

    /// A step has failed: let go; if that does not help, begin anew.
    void
    recover(const std::string &message);

    void
    undo();

    void
    begin_anew();

    void
    save_pose();

    void
    show_frame();

    void
    choose_colour(const std::string &name);

    void
    show_state();

    void
    show_status();

    void
    tell(const std::string &type, const std::string &text) const;

    /// By the field that is asked for; empty: none is.
    std::vector<double>
    colours() const;

    /// What is shown beside the body.
    struct Shown
    {
      SolveReport   report;
      std::uint32_t n_frames = 0;
      std::uint32_t pointer  = 0; ///< the newest place that the body knows
    };

    Stage                  &stage;
    Mailbox                &mailbox;
    const Outbox            outbox;
    const BodySurface       surface;
    Hand                    hand;
    std::vector<Hand::Held> held_before; ///< at the moments that the stage keeps
    Pace                    pace;
    Shown                   shown;
    Wish                    wish;
    bool                    state_is_new   = false; ///< to viewers
    unsigned int            n_single_steps = 0;     ///< to make in a pause
    unsigned int            n_failures     = 0;     ///< one after the other
  };
} // namespace Exemplar::Live

#endif
