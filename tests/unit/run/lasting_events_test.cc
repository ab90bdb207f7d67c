// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/problem/session_player.h>

#include "scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace Exemplar::Testing
{
  namespace
  {
    const std::string dynamic_bar = "set Scene = dynamic\n" + bar + examples(two_poses)
                                    + "subsection Handles\n set Names = left\n" + held_left
                                    + "end\nsubsection Time\n set Step = 0.01\n set End = 1\nend\n";

    /// Random things that a hand may do: what is grabbed or held comes and goes.
    class RandomHand
    {
    public:
      explicit RandomHand(const unsigned int seed) : generator(seed) {}

      Session
      events(const unsigned int n)
      {
        Session session;
        while (session.size() < n)
          session.push_back(next());
        return session;
      }

    private:
      double
      number(const double least, const double greatest)
      {
        return std::uniform_real_distribution<double>(least, greatest)(generator);
      }

      /// Take it, move it or let go of it, which `is_taken` says.
      SessionEvent
      next_of(bool &is_taken, const SessionEvent &take, const SessionEvent &move, const char *end)
      {
        if (is_taken && number(0., 1.) < 0.2)
        {
          is_taken = false;
          return { 1, end, take.name, {}, {} };
        }
        const bool moves = is_taken;
        is_taken         = true;
        return moves ? move : take;
      }

      SessionEvent
      next()
      {
        const double              x = number(0.5, 1.), y = number(0., 0.2);
        const std::string         name   = number(0., 1.) < 0.5 ? "a" : "left";
        const std::vector<double> shift  = { y, 0., -y };
        const unsigned int        choice = static_cast<unsigned int>(number(0., 10.));
        if (choice < 3)
          return next_of(is_grabbed, { 1, "grab", "a", { 9 }, { x, 0., 0., 0., 4., 0., y, 1e3 } },
                         { 1, "move", "a", {}, { 4., x, y } }, "release");
        if (choice < 6)
          return next_of(is_held[name],
                         { 1, "hold", name, { (name == "a" ? 3 : 8) + choice }, shift },
                         { 1, "shift", name, {}, shift }, "let go");
        const SessionEvent numbers[]
            = { { 1, "young", "", {}, { 1e5 * x } },         { 1, "poisson", "", {}, { 0.4 * x } },
                { 1, "density", "", {}, { 1e3 * x } },       { 1, "importance", "", {}, { x } },
                { 1, "gravity", "", {}, { 0., y, x } },      { 1, "damping", "", {}, { x, y } },
                { 1, "weights", "", {}, { 0., x, 1. - x } }, { 1, "weights", "", {}, {} } };
        return numbers[static_cast<unsigned int>(number(0., 8.))];
      }

      std::mt19937                generator;
      bool                        is_grabbed = false;
      std::map<std::string, bool> is_held;
    };

    LastingEvents
    lasting(const Session &session, const std::size_t first, const std::size_t end)
    {
      LastingEvents events;
      for (std::size_t i = first; i < end; ++i)
        events.add(session[i]);
      return events;
    }

    /// Where some steps lead from the scene's beginning.
    Vector
    steps(Problem &problem, const State &beginning)
    {
      problem.resume_from(beginning);
      for (unsigned int step = 0; step < 2; ++step)
        EXPECT_TRUE(is_success(problem.advance().status));
      return problem.state.positions;
    }

    TEST(LastingEvents, LeadToWhereAllEventsLead)
    {
      for (unsigned int seed = 0; seed < 12; ++seed)
      {
        const Session session = RandomHand(seed).events(200);
        Scene         all(dynamic_bar), short_cut(dynamic_bar), from_the_middle(dynamic_bar);
        const State   beginning = all.problem.state;
        SessionPlayer player(all.problem), other(short_cut.problem), third(from_the_middle.problem);
        for (std::size_t i = 0; i < session.size(); ++i)
        {
          player.apply(session[i]);
          if (i < 100)
            third.apply(session[i]);
        }
        other.catch_up(lasting(session, 0, 200));
        third.catch_up(lasting(session, 100, 200));
        EXPECT_LE(lasting(session, 0, 200).get().size(), 16U);
        const Vector reached = steps(all.problem, beginning);
        EXPECT_EQ(reached, steps(short_cut.problem, beginning)) << "seed " << seed;
        EXPECT_EQ(reached, steps(from_the_middle.problem, beginning)) << "seed " << seed;
      }
    }
  } // namespace
} // namespace Exemplar::Testing
