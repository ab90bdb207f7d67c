// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/solvers/staged_motion.h>

#include "expect_contains.h"
#include "scene.h"
#include "wall.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace Exemplar::Testing
{
  namespace
  {
    constexpr double width = 2e-3;

    /// A bar of which some nodes are held, below a plate that is lowered from just above it within a second.
    class LoweredPlate
    {
    public:
      LoweredPlate(const std::string &held,
                   const double       lowered_by,
                   const std::string &motion = "0; 0; 0")
          : scene("set Scene = static\nsubsection Mesh\n set Generator = box\n set Box size = 4, "
                  "1, 1\n set "
                  "Box cells = 12, 3, 3\nend\nsubsection Handles\n set Names = hand\n subsection "
                  "hand\n set "
                  "Select = "
                  + held + "\n set Motion = " + motion + "\n end\nend\n"),
            problem(scene.problem)
      {
        dealii::Tensor<1, 3> down;
        down[2] = -1.;
        const WallRules rules{ down,
                               [lowered_by](const double t)
                               { return -0.5 - 1.2 * width + lowered_by * t; },
                               width, 1e4 };
        problem.add_term(
            [&]
            {
              auto made = std::make_unique<Wall>(rules);
              made->move_to(0.);
              wall = made.get();
              return made;
            });
      }

      /// The number of stages, and where they lead.
      unsigned int
      go()
      {
        State &state = problem.state;
        problem.potential.begin_step(state, 1.);
        State end = state;
        problem.potential.set_time(1., end);
        problem.constraints.handles.move(1., end.positions);
        problem.system.factorize_metric(state.positions, state.weights);
        const std::function<bool()> uninterrupted;
        StagedMotion       motion(problem.potential, problem.constraints.handles, uninterrupted);
        const unsigned int n = motion.move(0., state.positions, 1., end.positions,
                                           [&](std::vector<double> &forces)
                                           { problem.system.bordered().apply_inverse(forces); });
        positions            = end.positions;
        return n;
      }

      Scene    scene;
      Problem &problem;
      Wall    *wall = nullptr;
      Vector   positions;
    };

    TEST(StagedMotionTest, ABodyIsCarriedBeforeAPlate)
    {
      for (const double widths : { 0.1, 10., 100. })
      {
        LoweredPlate plate("box -1 -1 -0.51 5 1 -0.49", widths * width);
        EXPECT_LE(plate.go(), 3u) << widths;
        const double least = plate.wall->least_distance(plate.positions);
        EXPECT_GT(least, 0.1 * width) << widths;
        if (widths >= 10.)
        {
          EXPECT_LT(least, width);
        }
        // what is carried takes the cells below it along
        EXPECT_NO_THROW(plate.problem.potential.get_body().update_rotations(plate.positions));
      }
    }

    TEST(StagedMotionTest, AHandThatLiftsTheBodyAgainstThePlateDoesNotPushItThrough)
    {
      LoweredPlate plate("box -1 -1 -0.51 5 1 -0.49", 0., "0; 0; 0.1*t");
      EXPECT_LE(plate.go(), 3u);
      EXPECT_GT(plate.wall->least_distance(plate.positions), 0.1 * width);
    }

    TEST(StagedMotionTest, WhatDoesNotGiveWayIsToldInWords)
    {
      LoweredPlate lowered("box -1 -1 0.49 5 1 0.51", 10. * width),
          lifted("box -1 -1 0.49 5 1 0.51", 0., "0; 0; 0.1*t"),
          meeting("box -1 -1 0.49 5 1 0.51", 1.2 * width); // which ends with no gap but rounding
      for (LoweredPlate *plate : { &lowered, &lifted, &meeting })
        try
        {
          plate->go();
          FAIL();
        }
        catch (const SolverFailure &failure)
        {
          expect_contains(failure.what(), "t = ");
          expect_contains(failure.what(), "handle 'hand'");
          expect_contains(failure.what(), "'wall'");
        }
    }

    /// A bar, held at its upper face, above a shape that is raised within one increment from just below it.
    struct RaisedShape
    {
      RaisedShape(const std::string &shape, const double raised_by)
          : scene("set Scene = static\nsubsection Mesh\n set Generator = box\n set Box size = 4, "
                  "1, 1\n set Box cells = 12, 3, 3\nend\nsubsection Handles\n set Names = hand\n "
                  "subsection hand\n set Select = box -1 -1 0.49 5 1 0.51\n end\nend\nsubsection "
                  "Time\n set Increments = 1\nend\nsubsection Obstacles\n set Names = it\n set "
                  "Distance = 2e-3\n subsection it\n set Shape = "
                  + shape + "\n set Motion = 0; 0; " + std::to_string(raised_by)
                  + "*t\n end\nend\n"),
            problem(scene.problem)
      {
      }

      Scene    scene;
      Problem &problem;
    };

    TEST(StagedMotionTest, EveryShapeCarriesTheBodyAndIsNotPassed)
    {
      using Place       = dealii::Tensor<1, 3>;
      using Depth       = std::function<double(const Place &, double)>;
      const double top  = -0.5 - 1.2 * width;
      const auto   text = [&](const double z) { return std::to_string(z); };
      const auto   across
          = [](const Place &x, const double z) { return std::hypot(x[0] - 2., x[2] - z); };
      const std::vector<std::pair<std::string, Depth>> shapes
          = { { "sphere 2 0 " + text(top - 1.) + " 1", [&](const Place &x, const double by)
                { return 1. - std::hypot(across(x, top - 1. + by), x[1]); } },
              { "capsule 2 -2 " + text(top - 1.) + " 2 2 " + text(top - 1.) + " 1",
                [&](const Place &x, const double by) { return 1. - across(x, top - 1. + by); } },
              { "box 1.4 -2 -2 2.6 2 " + text(top), [&](const Place &x, const double by)
                { return std::min(0.6 - std::abs(x[0] - 2.), top + by - x[2]); } },
              // thinner than its way is long
              { "box 1.4 -2 " + text(top - 0.01) + " 2.6 2 " + text(top),
                [&](const Place &x, const double by)
                { return std::min(0.6 - std::abs(x[0] - 2.), top + by - x[2]); } },
              { "inside box -2 -2 " + text(top) + " 6 2 2",
                [&](const Place &x, const double by) { return top + by - x[2]; } } };
      for (const auto &[shape, depth] : shapes)
        for (const double widths : { 10., 100. })
        {
          RaisedShape raised(shape, widths * width);
          Problem    &problem = raised.problem;
          ASSERT_EQ(problem.advance().status, SolveStatus::converged) << shape << widths;
          double deepest = -1.;
          for (unsigned int node = 0; node < problem.state.positions.size() / 3; ++node)
          {
            Place x;
            for (unsigned int c = 0; c < 3; ++c)
              x[c] = problem.state.positions[3 * node + c];
            deepest = std::max(deepest, depth(x, widths * width));
          }
          EXPECT_LT(deepest, 0.) << shape << widths;
          EXPECT_GT(deepest, -0.02) << shape << widths; // of nodes: balls meet triangles
        }
    }

    TEST(StagedMotionTest, AShapeIsRaisedInFewStages)
    {
      for (const std::string shape :
           { "sphere 2 0 -1.5024 1", "capsule 2 -2 -1.5024 2 2 -1.5024 1",
             "box 1.4 -2 -2 2.6 2 -0.5024", "inside box -2 -2 -0.5024 6 2 2" })
        for (const double widths : { 10., 100. })
        {
          RaisedShape raised(shape, widths * width);
          Problem    &problem = raised.problem;
          State      &state   = problem.state;
          problem.potential.begin_step(state, 1.);
          State end = state;
          problem.potential.set_time(1., end);
          problem.system.factorize_metric(state.positions, state.weights);
          const std::function<bool()> uninterrupted;
          StagedMotion motion(problem.potential, problem.constraints.handles, uninterrupted);
          problem.potential.move_to(0.);
          EXPECT_LE(motion.move(0., state.positions, 1., end.positions,
                                [&](std::vector<double> &forces)
                                { problem.system.bordered().apply_inverse(forces); }),
                    3u)
              << shape << widths;
        }
    }

    TEST(StagedMotionTest, StaticsPressABodyBelowAPlate)
    {
      for (const double widths : { 10., 100. })
      {
        LoweredPlate plate("box -1 -1 -0.51 5 1 -0.49", widths * width);
        const State  before = plate.problem.state;
        while (plate.problem.state.step < plate.problem.time_axis.n_steps())
        {
          ASSERT_EQ(plate.problem.advance().status, SolveStatus::converged) << widths;
          EXPECT_GT(plate.wall->least_distance(plate.problem.state.positions), 0.);
        }
        EXPECT_NEAR(max_difference(plate.problem.state.positions, before.positions),
                    (widths - 1.2) * width, 0.3 * widths * width);
      }
    }
  } // namespace
} // namespace Exemplar::Testing
