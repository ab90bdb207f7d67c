// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/potential/barrier.h>
#include <exemplar/potential/obstacle_term.h>

#include "expect_contains.h"
#include "scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace Exemplar::Testing
{
  TEST(Barrier, DerivativesAreThoseOfTheEnergy)
  {
    const Barrier barrier{ 3., 0.2 };
    for (const double d : { 1e-6, 1e-3, 0.05, 0.12, 0.19, 0.1999 })
    {
      const double h = 1e-5 * std::min(d, 0.2 - d);
      EXPECT_NEAR(barrier.slope(d), (barrier.value(d + h) - barrier.value(d - h)) / (2. * h),
                  1e-5 * std::abs(barrier.slope(d)) + 1e-9);
      EXPECT_NEAR(barrier.curvature(d), (barrier.slope(d + h) - barrier.slope(d - h)) / (2. * h),
                  1e-5 * barrier.curvature(d));
      EXPECT_GT(barrier.curvature(d), 0.);
    }
    EXPECT_EQ(barrier.value(0.2), 0.);
    EXPECT_EQ(barrier.slope(0.3), 0.);
    EXPECT_EQ(barrier.value(0.), std::numeric_limits<double>::infinity());
    EXPECT_EQ(barrier.value(-1.), std::numeric_limits<double>::infinity());
    EXPECT_NEAR(barrier.slope(0.53 * 0.2), -3., 0.1); // force k at s = .53
  }

  namespace
  {
    /// A bar in |y|, |z| <= .5 above an obstacle that pushes from 0.2 m on, which reaches to z = -.75 at most.
    const std::string bar_above = "set Scene = dynamic\n" + bar
                                  + "subsection Obstacles\n set Names = it\n set Distance = 0.2\n "
                                    "set Slip speed = 1\n subsection it\n"
                                    "set Friction = 0.5\n end\nend\n";

    const std::vector<std::string> shapes
        = { "plane 0 0 -0.9  0.1 0.2 1",           "sphere 2.1 0.1 -1.45 0.7",
            "capsule 1 0.2 -1.2 3 0.25 -1.25 0.4", "capsule 1 0 -1.2 3 0 -1.2 0.4",
            "box 1.2 -0.3 -2 2.7 1 -0.75",         "inside box -3 -3 -0.75 7 3 3" };

    struct Above
    {
      explicit Above(const std::string &shape, const std::vector<std::string> &more = {})
          : scene(bar_above, with(shape, more)), problem(scene.problem)
      {
        for (const auto &candidate : problem.potential.get_terms())
          if (candidate->name() == "obstacles")
            term = dynamic_cast<ObstacleTerm *>(candidate.get());
      }

      static std::vector<std::string>
      with(const std::string &shape, std::vector<std::string> more)
      {
        more.push_back("Obstacles/it/Shape=" + shape);
        return more;
      }

      /// The bar lowered and disturbed.
      Vector
      lowered(const double by, const unsigned int seed) const
      {
        std::mt19937                     generator(seed);
        std::normal_distribution<double> normal;
        Vector                           x = problem.body.fe_space.rest_positions();
        for (unsigned int dof = 0; dof < x.size(); ++dof)
          x[dof] += 5e-3 * normal(generator) - (dof % 3 == 2 ? by : 0.);
        return x;
      }

      ElasticSums
      sums(const Vector &x) const
      {
        ElasticSums result;
        result->gradient.reinit(x.size());
        result->force_scale.reinit(x.size() / 3);
        term->add({ x, {} }, result);
        return result;
      }

      Scene         scene;
      Problem      &problem;
      ObstacleTerm *term = nullptr;
    };

    Vector
    random_direction(const std::size_t n)
    {
      std::mt19937                     generator(11);
      std::normal_distribution<double> normal;
      Vector                           v(n);
      for (double &entry : v)
        entry = normal(generator);
      return v;
    }

    void
    expect_derivatives(const Above &above, const Vector &x)
    {
      const Vector      v      = random_direction(x.size());
      const ElasticSums here   = above.sums(x);
      const double      h      = 1e-6;
      Vector            before = x, after = x;
      before.add(-h, v);
      after.add(h, v);
      const ElasticSums sums_before = above.sums(before), sums_after = above.sums(after);
      EXPECT_GT(here->energy, 0.);
      const double slope = here->gradient * v;
      EXPECT_NEAR((sums_after->energy - sums_before->energy) / (2. * h), slope,
                  1e-5 * here->gradient.l2_norm());
      ElasticSums response;
      response->gradient.reinit(x.size());
      above.term->add_response({ x, {} }, Tangent::exact, v, response);
      Vector differences = sums_after->gradient;
      differences -= sums_before->gradient;
      differences /= 2. * h;
      differences -= response->gradient;
      EXPECT_LT(differences.l2_norm(), 1e-4 * response->gradient.l2_norm());
      ElasticSums convex;
      convex->gradient.reinit(x.size());
      above.term->add_response({ x, {} }, Tangent::convex, v, convex);
      EXPECT_GE(convex->gradient * v, 0.);
    }
  } // namespace

  TEST(ObstacleTerm, DerivativesAreThoseOfTheEnergy)
  {
    for (const std::string &shape : shapes)
    {
      SCOPED_TRACE(shape);
      const Above above(shape);
      for (const unsigned int seed : { 1, 2, 3 })
      {
        const Vector x = above.lowered(0.15, seed);
        EXPECT_GT(above.term->contacts(x).size(), 0);
        expect_derivatives(above, x);
        // the same while it rubs
        above.term->begin_step(above.problem.state, 0.02);
        EXPECT_EQ(above.term->renew({ x, {} }), TermChange::values);
        expect_derivatives(above, x);
        above.term->leave_step();
      }
    }
  }

  TEST(ObstacleTerm, TheConvexTangentIsAboveTheExactOne)
  {
    // so that a step with it is never longer than what the curvature of distances allows: far below
    // the width that curvature is the greater part
    std::mt19937                     generator(3);
    std::normal_distribution<double> normal;
    for (const std::string &shape : shapes)
    {
      SCOPED_TRACE(shape);
      const Above  above(shape);
      const auto   all     = above.term->contacts(above.lowered(0.15, 2));
      unsigned int n_above = 0;
      for (const Contact &contact : all)
      {
        const ContactHessian exact  = hessian_of(contact, Tangent::exact),
                             convex = hessian_of(contact, Tangent::convex);
        const unsigned int n        = contact.gap.n_nodes;
        for (unsigned int sample = 0; sample < 20; ++sample)
        {
          std::array<SpaceVector3, 3> v;
          double                      of_exact = 0., of_convex = 0., size = 0.;
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int c = 0; c < 3; ++c)
              v[i][c] = normal(generator);
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int j = 0; j < n; ++j)
            {
              of_exact += v[i] * (exact[i][j] * v[j]);
              of_convex += v[i] * (convex[i][j] * v[j]);
              size += exact[i][j].norm();
            }
          EXPECT_GE(of_convex, std::max(0., of_exact) - 1e-12 * size);
          n_above += of_convex > of_exact + 1e-12 * size;
        }
      }
      EXPECT_EQ(n_above > 0, !all[0].at.is_flat);
    }
  }

  TEST(ObstacleTerm, RoundingOfDistancesIsKnown)
  {
    // of a node at a distance d, k/w * O(1) times the rounding of both points
    const Above above("plane 0 0 -0.7 0 0 1");
    Vector      x = above.problem.state.positions;
    EXPECT_EQ(above.term->rounding_force(x), 0.);
    for (unsigned int dof = 2; dof < x.size(); dof += 3)
      x[dof] -= 0.1;
    const double own  = above.term->rounding_force(x);
    double       most = 0.;
    for (const Contact &contact : above.term->contacts(x))
      most = std::max(most, contact.gap.stiffness / contact.gap.width);
    EXPECT_GT(own, most * 1e-16);
    EXPECT_LT(own, most * 1e-13);
  }

  TEST(ObstacleTerm, SlopesAreDifferentiatedWithWhatFrictionLags)
  {
    for (const std::string &shape : shapes)
    {
      SCOPED_TRACE(shape);
      const Above  above(shape, { "Obstacles/it/Turn=0.2*t; 5*t; t" });
      const Vector x = above.lowered(0.15, 6), start = above.lowered(0.14, 7),
                   along = random_direction(x.size());
      // forces along the displacement, with friction found again at the end
      const auto slope = [&](const Vector &end, const Vector &begin)
      {
        State state     = above.problem.state;
        state.positions = begin;
        above.term->begin_step(state, 0.02);
        above.term->set_time(0.02);
        above.term->renew({ end, {} });
        return above.sums(end)->gradient * along;
      };
      Vector way = random_direction(x.size());
      way *= 1. / way.linfty_norm();
      const auto difference = [&](const auto &function)
      {
        constexpr double h = 1e-5;
        return (8. * (function(h) - function(-h)) - function(2. * h) + function(-2. * h))
               / (12. * h);
      };
      const auto moved = [&](const Vector &from, const double part)
      {
        Vector result = from;
        result.add(part, way);
        return result;
      };
      const double by_end   = difference([&](const double h) { return slope(moved(x, h), start); });
      const double by_start = difference([&](const double h) { return slope(x, moved(start, h)); });
      slope(x, start);
      const TouchingSlopes found = above.term->slopes(x, along, above.problem.body.fe_space);
      EXPECT_NEAR(found.by_positions * way, by_end, 1e-6 * std::abs(by_end));
      EXPECT_NEAR(found.by_start * way, by_start, 1e-6 * std::abs(by_start));
      above.term->leave_step();
    }
  }

  TEST(ObstacleTerm, ForcesHaveNoTorqueAboutTheObstacle)
  {
    // the body's forces on a sphere go through its middle
    const Above  above("sphere 2.1 0.1 -1.45 0.7");
    const Vector x   = above.lowered(0.15, 4);
    const auto   all = above.term->contacts(x);
    ASSERT_FALSE(all.empty());
    for (const Contact &contact : all)
    {
      SpaceVector3 point;
      for (unsigned int i = 0; i < contact.gap.n_nodes; ++i)
        for (unsigned int c = 0; c < 3; ++c)
          point[c] += contact.gap.coefficients[i] * x[3 * contact.gap.nodes[i] + c];
      const SpaceVector3 arm = point - dealii::Point<3>(2.1, 0.1, -1.45);
      EXPECT_NEAR(dealii::cross_product_3d(arm, contact.gap.normal).norm(), 0., 1e-12);
      EXPECT_NEAR(arm.norm() - 0.7, contact.gap.distance, 1e-12);
    }
  }

  TEST(ObstacleTerm, FrictionIsThatOfTheVelocityOfTheScheme)
  {
    // by BDF2 the body stands still where it ends a third of the last step farther
    for (const std::string scheme : { "implicit euler", "bdf2" })
    {
      const Above above("plane 0 0 -0.9 0 0 1", { "Time/Scheme=" + scheme });
      State       state = above.problem.state;
      for (unsigned int dof = 2; dof < state.positions.size(); dof += 3)
        state.positions[dof] -= 0.3;
      Vector still              = state.positions;
      state.previous_positions  = state.positions;
      state.previous_velocities = state.velocities;
      state.previous_step       = 0.02;
      for (unsigned int dof = 0; dof < still.size(); dof += 3)
      {
        state.previous_positions[dof] -= 0.3;
        still[dof] += scheme == "bdf2" ? 0.1 : 0.;
      }
      above.problem.potential.begin_step(state, 0.02);
      const auto along = [&](const Vector &x)
      {
        const ElasticSums sums = above.sums(x);
        double            most = 0.;
        for (unsigned int dof = 0; dof < x.size(); dof += 3)
          most = std::max(most, std::abs(sums->gradient[dof]));
        return most;
      };
      EXPECT_NEAR(along(still), 0., 1e-6);
      Vector moved = still;
      for (unsigned int dof = 0; dof < still.size(); dof += 3)
        moved[dof] += 1e-3;
      EXPECT_GT(along(moved), 1.);
      above.problem.potential.leave_step(state);
    }
  }

  TEST(ObstacleTerm, StepsEndBeforeTheObstacle)
  {
    for (const std::string &shape : shapes)
    {
      SCOPED_TRACE(shape);
      const Above  above(shape);
      const Vector x = above.lowered(0.1, 5);
      Vector       way(x.size());
      for (unsigned int dof = 2; dof < way.size(); dof += 3)
        way[dof] = -3.;
      const double part = above.term->max_step(x, way);
      EXPECT_GT(part, 0.);
      EXPECT_LT(part, 0.1);
      const auto least = [&](const double length)
      {
        Vector there = x;
        there.add(length, way);
        double distance = 1e300;
        for (const Contact &contact : above.term->contacts(there, 10.))
          distance = std::min(distance, contact.gap.distance);
        return distance;
      };
      EXPECT_GE(least(part), 0.0999 * least(0.));
      EXPECT_LE(least(part), 0.35 * least(0.));
      way *= -1.;
      EXPECT_GE(above.term->max_step(x, way), shape.compare(0, 6, "inside") == 0 ? 0.5 : 1.);
    }
  }

  TEST(ObstacleTerm, AWayThatEndsAtTheObstacleIsBound)
  {
    // boxes of what ends as far as that may not meet, by rounding
    for (const double length : { 0.249, 0.25 - 1e-9, 0.25, 0.25 + 1e-15 })
    {
      const Above above("sphere 2.1 0.1 -1.45 0.7");
      Vector      way(above.problem.state.positions.size());
      for (unsigned int dof = 2; dof < way.size(); dof += 3)
        way[dof] = -length;
      const double part = above.term->max_step(above.problem.state.positions, way);
      EXPECT_GT(part, 0.85);
      EXPECT_LT(part, 0.95);
    }
  }

  TEST(ObstacleTerm, AWayThroughAShapeEndsBehindIt)
  {
    const auto distances = [](const std::vector<Gap> &gaps)
    {
      std::vector<double> result;
      for (const Gap &gap : gaps)
        result.push_back(gap.distance);
      return result;
    };
    for (std::string shape : shapes)
    {
      if (shape.substr(0, 3) == "box")
        shape = "box 1.2 -0.3 -0.8 2.7 1 -0.75"; // thinner than the way is long
      Above        at_rest(shape), moved(shape, { "Obstacles/it/Motion=0; 0; 0.6*t" });
      Vector       lowered = at_rest.lowered(0., 1);
      const Vector start   = lowered;
      for (unsigned int dof = 2; dof < lowered.size(); dof += 3)
        lowered[dof] -= 0.6;
      std::vector<Gap> of_body, of_obstacle;
      at_rest.term->append_gaps_of_way(0., 0., start, lowered, 0.45, of_body);
      moved.term->append_gaps_of_way(0., 1., start, start, 0.45, of_obstacle);
      const std::vector<double> first = distances(of_body), second = distances(of_obstacle);
      ASSERT_GT(first.size(), 0u) << shape;
      ASSERT_EQ(first.size(), second.size()) << shape;
      for (std::size_t i = 0; i < first.size(); ++i)
        EXPECT_NEAR(first[i], second[i], 1e-9) << shape;
      const double least = *std::min_element(first.begin(), first.end());
      EXPECT_LT(least, -0.25) << shape;
      EXPECT_GT(least, -0.7) << shape;
      // it has been left where it was, and what meets nothing has the gaps of its end
      std::vector<Gap> there, of_short_way;
      const Vector     near = at_rest.lowered(0.1, 1);
      moved.term->append_gaps(near, 0.9, there);
      moved.term->append_gaps_of_way(0., 0., start, near, 0.9, of_short_way);
      EXPECT_EQ(distances(there), distances(of_short_way)) << shape;
    }
  }

  TEST(ObstacleTerm, WhatTouchesAtTheStartIsNotPushed)
  {
    for (const std::string shape : { "plane 0 0 -0.5 0 0 1", "box -1 -1 -2 5 1 -0.4999",
                                     "inside box -1 -2 -0.5 5 2 2", "sphere 2 0 -1.5 1" })
    {
      SCOPED_TRACE(shape);
      const Above above(shape);
      EXPECT_EQ(above.sums(above.problem.state.positions)->energy, 0.);
      ASSERT_EQ(above.problem.actions.notes.size(), 1);
      expect_contains(above.problem.actions.notes[0], "set back by");
    }
  }

  TEST(ObstacleTerm, ABodyThatBeginsInsideIsRefused)
  {
    const auto message = [](const std::string &shape) -> std::string
    {
      try
      {
        const Above above(shape);
      }
      catch (const UserError &error)
      {
        return error.what();
      }
      return "";
    };
    expect_contains(message("plane 0 0 0 0 0 1"),
                    "0.5 m deep. A displacement of the body by (0, 0, 0.5");
    expect_contains(message("box 1 -0.2 -0.2 2 0.2 0.2"), "begins inside");
    expect_contains(message("box -1 -3 -3 7 3 3"), "begins inside");
    expect_contains(message("sphere 2 0 0 0.1"), "begins inside");
    expect_contains(message("capsule 2 0 -9 2 0 9 0.1"), "begins inside");
  }
} // namespace Exemplar::Testing
