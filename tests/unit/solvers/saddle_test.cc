// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/solvers/saddle.h>

#include "landscape.h"

#include <gtest/gtest.h>

#include <cmath>

namespace Exemplar::Testing
{
  namespace
  {
    /// a^4 / 4 - k a^2 / 2 + b^2 / 2: for k > 0 the origin is a saddle point between two minima.
    Landscape
    two_valleys(const double k)
    {
      return valley([=](const double a) { return std::pow(a, 4) / 4. - k * a * a / 2.; },
                    [=](const double a) { return std::pow(a, 3) - k * a; },
                    [=](const double a) { return 3. * a * a - k; }, 2.1);
    }

    Vector
    downward_curvature_at(TwoUnknowns &unknowns)
    {
      unknowns.system.factorize(unknowns.state.positions, {}, 0.5);
      return downward_curvature(unknowns.system, unknowns.potential, unknowns.state);
    }

    TEST(Saddle, ItsCurvatureLeadsDownBesideAStiffDirection)
    {
      for (const double k : { 0.1, 1. })
      {
        TwoUnknowns  unknowns(two_valleys(k), 0., 0.);
        const Vector v = downward_curvature_at(unknowns);
        ASSERT_EQ(v.size(), unknowns.state.positions.size());
        const double a = v[unknowns.dofs[0]], b = v[unknowns.dofs[1]];
        EXPECT_LT(-k * a * a + b * b, 0.);
        EXPECT_NEAR(v.linfty_norm(), 1., 1e-15);
        EXPECT_NEAR(v.l1_norm(), std::abs(a) + std::abs(b), 1e-15); // what is held stays
      }
    }

    TEST(Saddle, AMinimumHasNoWayDown)
    {
      TwoUnknowns unknowns(two_valleys(1.), 1., 0.);
      EXPECT_EQ(downward_curvature_at(unknowns).size(), 0u);
    }

    /// The same, but near the saddle point the gradient is 0.01 off along b, as rounding may make it:
    /// along what it says the potential rises.
    Landscape
    two_valleys_with_noise()
    {
      Landscape  landscape = two_valleys(1.);
      const auto exact     = landscape.gradient;
      landscape.gradient   = [exact](const double a, const double b)
      {
        Landscape::Pair gradient = exact(a, b);
        if (std::abs(a) < 1e-5 && std::abs(b) < 1e-3)
          gradient[1] += 0.01;
        return gradient;
      };
      return landscape;
    }

    TEST(Saddle, WhereNoStepLeadsDownhillNewtonFollowsTheCurvature)
    {
      TwoUnknowns unknowns(two_valleys_with_noise(), 0., 0.);
      EXPECT_EQ(unknowns.solve(by_method(Method::newton)).status, SolveStatus::converged);
      EXPECT_NEAR(std::abs(unknowns.a()), 1., 1e-9);
      EXPECT_NEAR(unknowns.b(), 0., 1e-9);
    }

    TEST(Saddle, IsLeftNoFurtherThanAWall)
    {
      bool        was_beyond = false;
      TwoUnknowns unknowns(between_walls(two_valleys_with_noise(), 1e-4, was_beyond), 0., 0.);
      unknowns.solve(by_method(Method::newton));
      EXPECT_FALSE(was_beyond);
    }

    TEST(Saddle, WhereNothingLeadsDownhillNewtonStalls)
    {
      Landscape landscape = two_valleys_with_noise();
      // of a bowl, which the tangent takes for a saddle point
      landscape.energy    = [](const double a, const double b) { return a * a / 2. + b * b / 2.; };
      const auto gradient = landscape.gradient;
      landscape.gradient  = [gradient](const double a, const double b) {
        return Landscape::Pair{ { a, gradient(a, b)[1] } };
      };
      TwoUnknowns       unknowns(landscape, 0., 0.);
      const SolveReport report = unknowns.solve(by_method(Method::newton));
      EXPECT_EQ(report.status, SolveStatus::stalled);
      EXPECT_EQ(unknowns.a(), 0.); // the state is as it was
      EXPECT_EQ(unknowns.b(), 0.);
    }
  } // namespace
} // namespace Exemplar::Testing
