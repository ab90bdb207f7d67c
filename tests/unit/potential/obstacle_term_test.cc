// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/potential/barrier.h>
#include <exemplar/potential/obstacle_term.h>

#include "expect_contains.h"
#include "scene.h"

#include <gtest/gtest.h>

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
