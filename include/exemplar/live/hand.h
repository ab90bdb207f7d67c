// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_hand_h
#define exemplar_live_hand_h

#include <exemplar/live/command.h>
#include <exemplar/live/settings.h>
#include <exemplar/live/surface_patch.h>
#include <exemplar/run/session/session.h>

#include <map>
#include <string>

namespace Exemplar::Live
{
  /// Translation of viewers' commands into events of the body, with the state of all that is held
  /// by hand. All functions throw std::invalid_argument, in words for the viewer, for commands that
  /// the body does not allow.
  class Hand
  {
  public:
    /// A grip that follows a pointer smoothly. A pointer jumps, because its place is sent a few
    /// times a second, because the body is behind the clock, or because a hand was jerked; the grip
    /// does not.
    struct Pull
    {
      std::string          moving, ending, of; ///< kinds of its events, and their name
      dealii::Point<3>     from;               ///< origin of its displacement [m]
      dealii::Point<3>     at, to;             ///< place of the grip, place of the pointer [m]
      dealii::Tensor<1, 3> way = {};           ///< displacement in the last step [m]
    };

    /// All that is held by hand, by the names that viewers gave.
    struct Held
    {
      std::map<std::string, Pull>                      pulls, handles, obstacles;
      std::map<std::string, std::vector<unsigned int>> pins; ///< nodes, ascending
      WeightSliders                                    weights;
      double importance = 1.; ///< the last one above its lower bound
    };

    /// Takes a problem at its beginning; keeps a reference to `surface`.
    Hand(const Problem &problem, const BodySurface &surface);

    /// The events of a command that are to be done at once. Throws for commands that do not concern
    /// the hand.
    Session
    events_of(const Command &command, const Problem &problem);

    /// Moves all grips towards their pointers, before the next step of the problem.
    Session
    follow(const Problem &problem);

    /// Releases all pulls; pins stay.
    Session
    let_go_of_all(const Problem &problem);

    /// Ends the motion of the scene's handles and of obstacles where they were before follow(), when `before` was held.
    Session
    stop_handles(const Held &before, const Problem &problem);

    bool
    pulls() const
    {
      return !held.pulls.empty();
    }

    /// The importance, or, while the examples are put out of action, the one before.
    double
    importance_with_examples(const Problem &problem) const;

    const Settings &
    get_settings() const
    {
      return settings;
    }

    const Held &
    get_held() const
    {
      return held;
    }

    /// Restores the state that get_held() returned.
    void
    restore(const Held &earlier)
    {
      held = earlier;
    }

    /// Stiffness of a spring of strength 1 [N/m].
    double
    unit_stiffness() const
    {
      return stiffness;
    }

    /// Radius of the patch that a pull takes hold of, at rest [m].
    double
    grab_radius() const;

  private:
    Session
    grab(const Command &command, const Problem &problem);
    void
    move(const Command &command);
    Session
    release(const std::string &name, const Problem &problem);
    Session
    pin(const Command &command, const Problem &problem);
    Session
    move_handle(const Command &command, const Problem &problem);
    SessionEvent
    set(const Command &command, const Problem &problem);
    SessionEvent
    put(const Command &command, const Problem &problem);
    Session
    carry(const Command &command, const Problem &problem);
    Session
    take_away(const Command &command, const Problem &problem);

    /// Lets the nodes of a patch follow the pointer, without a spring.
    Session
    grab_hard(const std::string      &name,
              const dealii::Point<3> &place,
              const SurfacePatch     &patch,
              const Problem          &problem);

    /// The nodes of vertices, ascending.
    std::vector<unsigned int>
    nodes_of(const std::vector<unsigned int> &vertices) const;

    /// Throws for a place that is a thousand times the body's size away.
    void
    check_place(const std::vector<double> &numbers, std::size_t first) const;

    const BodySurface &surface;
    const double       diameter, stiffness;
    const double       max_way; ///< largest displacement of a grip in a step [m]
    const Vector       rest;    ///< rest positions [m]
    const Settings     settings;
    Held               held;
  };
} // namespace Exemplar::Live

#endif
