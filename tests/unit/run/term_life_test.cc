// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/output/diagnostics.h>
#include <exemplar/run/output/frame_output.h>

#include "expect_contains.h"
#include "scene.h"
#include "ties.h"

#include <gtest/gtest.h>

// A term that uses all of a term's life: it couples other nodes within a step, bounds steps, remembers, makes heat and
// shows a field.
namespace Exemplar::Testing
{
  namespace
  {
    const std::string sagging
        = bar + "subsection Handles\n set Names = left\n" + held_left
          + "end\nsubsection Loads\n set Gravity = 0, 0, -5\nend\n"
            "subsection Solver\n set Tolerance = 1e-12\n set Step tolerance = 1e-12\nend\n";
    const std::string sagging_bar
        = "set Scene = static\nsubsection Time\n set Increments = 1\nend\n" + sagging;
    const std::string falling_bar
        = "set Scene = dynamic\nsubsection Time\n set Step = 0.05\n set End = 1\nend\n" + sagging;

    /// The pair of the lower corners of both ends, 4 m apart at rest.
    NodePairs
    lower_corners(const Problem &problem)
    {
      const std::vector<dealii::Point<3>> &nodes = problem.body.mesh.get_nodes();
      const auto                           find  = [&](const dealii::Point<3> &place) {
        return static_cast<unsigned int>(std::find(nodes.begin(), nodes.end(), place)
                                         - nodes.begin());
      };
      return { { find({ 4., -0.5, -0.5 }), find({ 0., -0.5, -0.5 }) } };
    }

    double
    distance(const Vector &x, const NodePairs &pairs)
    {
      double square = 0.;
      for (unsigned int c = 0; c < 3; ++c)
        square += std::pow(x[3 * pairs[0].first + c] - x[3 * pairs[0].second + c], 2);
      return std::sqrt(square);
    }

    /// A scene whose lower corners may tie.
    struct TiedScene
    {
      explicit TiedScene(const std::string &text,
                         const double       reach,
                         const double       limit         = 100.,
                         const double       greatest_step = std::numeric_limits<double>::infinity(),
                         const std::vector<std::string> &overrides = {})
          : scene(text, overrides), problem(scene.problem), pairs(lower_corners(problem))
      {
        const TieRules rules{ pairs, 1e4, reach, limit, greatest_step };
        problem.add_term([rules] { return std::make_unique<Ties>(rules); });
      }

      std::optional<double>
      column(const std::string &name)
      {
        std::optional<double> value;
        Diagnostics           diagnostics(problem);
        for (const StatisticsCell &cell : diagnostics.row(problem.state, SolveReport()))
          if (cell.column == name)
            value = std::get<double>(cell.value);
        return value;
      }

      void
      advance()
      {
        ASSERT_TRUE(is_success(problem.advance().status));
      }

      Scene           scene;
      Problem        &problem;
      const NodePairs pairs;
    };

    TEST(TermLife, WhatIsTiedWithinAStepIsPartOfItsEnd)
    {
      const State free = Scene(sagging_bar).solve();
      TiedScene   always(sagging_bar, 10.); // tied at rest
      TiedScene   later(sagging_bar, 3.95);
      for (TiedScene *tied : { &always, &later })
        tied->advance();
      EXPECT_LT(distance(free.positions, later.pairs), 3.95);
      EXPECT_GT(max_difference(free.positions, later.problem.state.positions), 0.01);
      EXPECT_LT(max_difference(always.problem.state.positions, later.problem.state.positions),
                1e-9);
      EXPECT_EQ(later.column("ties"), 1.);
      const double d = distance(later.problem.state.positions, later.pairs);
      EXPECT_NEAR(*later.column("energy_ties"), 0.5e4 * (d * d - 3.95 * 3.95), 1e-6);
    }

    TEST(TermLife, BothMethodsTieInTheSameSteps)
    {
      TiedScene quasi(falling_bar, 3.95),
          newton(falling_bar, 3.95, 100., 10., { "Solver/Method=newton" });
      double ties = 0.;
      for (unsigned int step = 0; step < 20; ++step)
      {
        quasi.advance();
        newton.advance();
        EXPECT_LT(max_difference(quasi.problem.state.positions, newton.problem.state.positions),
                  1e-8)
            << step;
        ties += *quasi.column("ties");
      }
      EXPECT_GT(ties, 1.);
      EXPECT_LT(ties, 19.);
    }

    TEST(TermLife, AResumedRunGivesTheSameBytes)
    {
      for (const std::string method : { "quasi newton", "newton" })
      {
        const std::vector<std::string> by = { "Solver/Method=" + method };
        TiedScene                      whole(falling_bar, 3.95, 4.2, 10., by);
        std::vector<State>             states;
        std::vector<std::string>       memories;
        for (unsigned int step = 0; step < 20; ++step)
        {
          whole.advance();
          states.push_back(whole.problem.state);
          memories.push_back(whole.problem.solver_memory());
        }
        for (const unsigned int step : { 2u, 6u, 9u, 12u, 17u })
        {
          TiedScene rest(falling_bar, 3.95, 4.2, 10., by);
          rest.problem.resume_from(states[step], memories[step]);
          while (rest.problem.state.step < 20)
            rest.advance();
          EXPECT_EQ(rest.problem.state.positions, whole.problem.state.positions) << method << step;
          EXPECT_EQ(rest.problem.state.dissipated, whole.problem.state.dissipated)
              << method << step;
        }
      }
    }

    TEST(TermLife, WhatBreaksMakesHeatOfItsEnergy)
    {
      TiedScene tied("set Scene = static\nsubsection Time\n set Increments = 4\nend\n" + bar + drag,
                     4.06, 4.1);
      double    before = 0.;
      for (unsigned int step = 0; step < 4; ++step)
      {
        const bool was_tied = step > 0 && *tied.column("ties") == 1.;
        tied.advance();
        const double d = distance(tied.problem.state.positions, tied.pairs);
        if (was_tied && *tied.column("ties") == 0.)
        {
          EXPECT_NEAR(*tied.column("energy_dissipated") - before, 0.5e4 * (d * d - 4.06 * 4.06),
                      1e-8);
        }
        before = *tied.column("energy_dissipated");
      }
      EXPECT_GT(before, 1.);
      EXPECT_EQ(tied.column("ties"), 0.);
    }

    TEST(TermLife, HeldNodesGoInPartsOrAreRefusedByTheTermsName)
    {
      const std::string dragged
          = "set Scene = static\nsubsection Time\n set Increments = 1\nend\n" + bar + drag;
      const State at_once = Scene(dragged).solve();
      TiedScene   in_parts(dragged, 0., 100., 0.02);
      in_parts.advance();
      EXPECT_LT(max_difference(in_parts.problem.state.positions, at_once.positions), 1e-6);
      TiedScene         never(dragged, 0., 100., 0.001);
      const SolveReport report = never.problem.advance();
      EXPECT_EQ(report.status, SolveStatus::failed);
      expect_contains(never.problem.failure_message(report), "the term 'ties' does not let them");
    }

    TEST(TermLife, FramesShowItsField)
    {
      TiedScene tied(sagging_bar, 10.);
      tied.advance();
      const Frame frame = frame_of(tied.problem);
      ASSERT_EQ(frame.fields.size(), 1u);
      EXPECT_EQ(frame.fields[0].name, "force_of_ties");
      const unsigned int a = tied.pairs[0].first, b = tied.pairs[0].second;
      for (unsigned int c = 0; c < 3; ++c)
        EXPECT_EQ(frame.fields[0].values[3 * a + c],
                  1e4 * (frame.positions[3 * b + c] - frame.positions[3 * a + c]));
    }
  } // namespace
} // namespace Exemplar::Testing
