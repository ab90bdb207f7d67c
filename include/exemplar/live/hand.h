// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_hand_h
#define exemplar_live_hand_h

#include <exemplar/live/command.h>
#include <exemplar/live/settings.h>
#include <exemplar/live/surface_patch.h>
#include <exemplar/live/weight_sliders.h>
#include <exemplar/run/session/session.h>

#include <map>
#include <string>

namespace Exemplar::Live
{
  /// What viewers ask for, said of the body: makes events of commands, and knows what is held by hand.
  /// All functions throw std::invalid_argument, in words for the viewer, for what the body does not allow.
  class Hand
  {
  public:
    /// What is pulled to where a pointer is. A pointer jumps, because it is told of a few times a second,
    /// because the body is behind the clock, or because a hand was jerked; what is pulled does not.
    struct Pull
    {
      std::string          moving, ending, of; ///< what its events are, and of what
      dealii::Point<3>     from;               ///< where it counts from [m]
      dealii::Point<3>     at, to;             ///< where it is, and where the pointer is [m]
      dealii::Tensor<1, 3> way = {};           ///< that it went in the last step [m]
    };

    /// What is held by hand, by the names that viewers gave.
    struct Held
    {
      std::map<std::string, Pull>                      pulls, handles;
      std::map<std::string, std::vector<unsigned int>> pins; ///< nodes, ascending
      WeightSliders                                    weights;
      double importance = 1.; ///< the last one with which the examples acted
    };

    /// Of a scene at its beginning; keeps a reference to `surface`.
    Hand(const Problem &problem, const BodySurface &surface);

    /// What is to be done at once. Throws for commands that are no hand's.
    Session
    events_of(const Command &command, const Problem &problem);

    /// Let all that is pulled come nearer to its pointer, before the next step of the problem.
    Session
    follow(const Problem &problem);

    /// All that pulls is let go of; pins stay.
    Session
    let_go_of_all(const Problem &problem);

    bool
    pulls() const
    {
      return !held.pulls.empty();
    }

    /// What the importance is, or was before the examples were put out of action.
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

    /// As it was when get_held() was this.
    void
    restore(const Held &earlier)
    {
      held = earlier;
    }

    /// Of a spring of strength 1 [N/m].
    double
    unit_stiffness() const
    {
      return stiffness;
    }

    /// Of the patch that a pull takes hold of, at rest [m].
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
    const double       max_way; ///< of a pull in a step [m]
    const Vector       rest;    ///< positions [m]
    const Settings     settings;
    Held               held;
  };
} // namespace Exemplar::Live

#endif
