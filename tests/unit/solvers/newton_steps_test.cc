// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>

#include "landscape.h"
#include "scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace Exemplar::Testing
{
  namespace
  {
    using Curve = std::function<double(double)>;

    /// The gradient along a in each iteration of Newton's method.
    std::vector<double>
    gradients(TwoUnknowns &unknowns)
    {
      const SolveReport report = unknowns.solve(by_method(Method::newton, 1e-12));
      EXPECT_EQ(report.status, SolveStatus::converged);
      return report.residual_history; // the scale of the forces is 1 N
    }

    TEST(NewtonStep, IsCorrectedWithTheSameFactorIfThatHalvesTheGradient)
    {
      const auto landscape = [](const Curve &f, const Curve &first, const Curve &second)
      { return valley(f, first, second, 1.); };
      struct Case
      {
        Curve  f, first, second;
        double start;
        bool   is_corrected; ///< the first step
      };
      const Case cases[]
          = { { [](const double a) { return a * a / 2. + std::pow(a, 4) / 4.; },
                [](const double a) { return a + std::pow(a, 3); },
                [](const double a) { return 1. + 3. * a * a; }, 1., true },
              // a Newton step leads from a to -a^3
              { [](const double a) { return std::sqrt(1. + a * a); },
                [](const double a) { return a / std::sqrt(1. + a * a); },
                [](const double a) { return std::pow(1. + a * a, -1.5); }, -0.9655, false } };
      for (const Case &c : cases)
      {
        TwoUnknowns  unknowns(landscape(c.f, c.first, c.second), c.start, 0.);
        const auto   r         = gradients(unknowns);
        const double predicted = c.start - c.first(c.start) / c.second(c.start),
                     step      = predicted - c.first(predicted) / c.second(predicted),
                     corrected = step - c.first(step) / c.second(predicted);
        ASSERT_EQ(std::abs(c.first(corrected)) < 0.5 * std::abs(c.first(step)), c.is_corrected);
        ASSERT_GT(r.size(), 1u);
        EXPECT_NEAR(r[0], std::abs(c.first(predicted)), 1e-9);
        EXPECT_NEAR(r[1], std::abs(c.first(c.is_corrected ? corrected : step)), 1e-9);
        EXPECT_NEAR(unknowns.a(), 0., 1e-9);
      }
    }

    /// The residual before the first iteration of a step from `start` to the minimum of
    /// a^2/2 + a^4/4 at 0, and the factorisations that the step takes.
    std::pair<double, unsigned int>
    residual_and_factors(const double start)
    {
      TwoUnknowns unknowns(valley([](const double a) { return a * a / 2. + std::pow(a, 4) / 4.; },
                                  [](const double a) { return a + std::pow(a, 3); },
                                  [](const double a) { return 1. + 3. * a * a; }, 1.),
                           start, 0.);
      const SolveReport report = unknowns.solve(by_method(Method::newton, 1e-9));
      EXPECT_EQ(report.status, SolveStatus::converged);
      EXPECT_NEAR(unknowns.a(), 0., 1e-8);
      return { report.residual_history.front(), unknowns.system.n_factorizations() };
    }

    TEST(NewtonStep, GoesOnWithTheFactorOfThePredictionWhereThatIsNearlyRight)
    {
      // a prediction from a leads to 2 a^3, and each further step with its factor takes 3 a^2 of that
      const auto [residual, n_factors] = residual_and_factors(0.05);
      EXPECT_LT(residual, 1e-9);
      EXPECT_EQ(n_factors, 1u);
      const auto [greater_residual, more_factors] = residual_and_factors(0.1);
      EXPECT_NEAR(greater_residual, 2e-3, 1e-4); // the tangent has changed too much
      EXPECT_GT(more_factors, 1u);
    }

    /// A hill at 0 between two minima at -1 and 1, of which the convex tangent is much too stiff.
    Landscape
    stiff_hill()
    {
      return valley([](const double a) { return std::pow(a, 4) / 4. - a * a / 2.; },
                    [](const double a) { return std::pow(a, 3) - a; },
                    [](const double a) { return 3. * a * a - 1.; }, 64.);
    }

    TEST(NewtonStep, OfTheConvexTangentGoesOnAsLongAsItFalls)
    {
      TwoUnknowns       unknowns(stiff_hill(), 1e-2, 0.);
      double            longest = 0.;
      const SolveReport report  = unknowns.solve(by_method(Method::newton),
                                                 [&](const SolveReport &now)
                                                 {
                                                  if (now.convexity > 0.)
                                                    longest = std::max(longest, now.step_length);
                                                  return true;
                                                });
      EXPECT_EQ(report.status, SolveStatus::converged);
      EXPECT_EQ(longest, 64.);
      EXPECT_NEAR(unknowns.a(), 1., 1e-9);
    }

    TEST(NewtonStep, TakesNoMoreOfTheConvexTangentThanItNeeds)
    {
      // exact -1 + 3 a^2 and convex 64: an eighth is enough on the hill, and none beyond it
      TwoUnknowns         unknowns(stiff_hill(), 1e-2, 0.);
      std::vector<double> seen;
      unknowns.solve(by_method(Method::newton),
                     [&](const SolveReport &now)
                     {
                       if (now.iterations > 0)
                         seen.push_back(now.convexity);
                       return true;
                     });
      ASSERT_FALSE(seen.empty());
      EXPECT_EQ(seen.front(), 0.125);
      EXPECT_EQ(seen.back(), 0.);
    }

    TEST(StepSolver, GoesNoFurtherThanATermAllows)
    {
      for (const Method method : { Method::newton, Method::quasi_newton })
      {
        Landscape bowl = valley([](const double a) { return std::cosh(a); },
                                [](const double a) { return std::sinh(a); },
                                [](const double a) { return std::cosh(a); }, 1.);
        bowl.max_step  = [](double, double, double, double) { return 0.3; };
        TwoUnknowns       unknowns(bowl, 1.5, 0.5);
        double            longest = 0.;
        const SolveReport report  = unknowns.solve(by_method(method),
                                                   [&](const SolveReport &now)
                                                   {
                                                    if (now.iterations > 0)
                                                      longest = std::max(longest, now.step_length);
                                                    return true;
                                                  });
        EXPECT_EQ(report.status, SolveStatus::converged);
        EXPECT_EQ(longest, 0.3);
        EXPECT_NEAR(unknowns.a(), 0., 1e-8);
      }
    }

    /// A pull towards a wall at 1 that is felt only near to it, in balance at 0.95.
    Landscape
    barrier(bool &was_beyond)
    {
      return between_walls(valley([](const double a) { return -a - 0.05 * std::log(1. - a); },
                                  [](const double a) { return -1. + 0.05 / (1. - a); },
                                  [](const double a) { return 0.05 / std::pow(1. - a, 2); }, 0.05),
                           1., was_beyond);
    }

    TEST(StepSolver, NoPredictionOrStepPassesAWall)
    {
      for (const Method method : { Method::newton, Method::quasi_newton })
        for (const double velocity : { 0., 5. })
        {
          bool        was_beyond = false;
          TwoUnknowns unknowns(barrier(was_beyond), 0., 0.);
          unknowns.state.velocities[unknowns.dofs[0]] = velocity;
          EXPECT_EQ(unknowns.solve(by_method(method)).status, SolveStatus::converged);
          EXPECT_NEAR(unknowns.a(), 0.95, 1e-8);
          EXPECT_FALSE(was_beyond);
        }
    }

    TEST(StepSolver, APassStopsBeforeAWall)
    {
      bool        was_beyond = false;
      TwoUnknowns unknowns(barrier(was_beyond), 0., 0.);
      EXPECT_EQ(unknowns.solve(by_method(Method::one_pass)).status, SolveStatus::one_pass);
      EXPECT_NEAR(unknowns.a(), 0.9, 1e-12); // of a step of 19
      EXPECT_FALSE(was_beyond);
    }

    TEST(NewtonStep, OfTheConvexTangentGoesOnNoFurtherThanAWall)
    {
      bool        was_beyond = false;
      TwoUnknowns unknowns(between_walls(stiff_hill(), 0.03, was_beyond), 0.01, 0.);
      unknowns.solve(by_method(Method::newton));
      EXPECT_GT(unknowns.a(), 0.);
      EXPECT_FALSE(was_beyond);
    }

    TEST(NewtonStep, IsNotCorrectedBeyondAWall)
    {
      // a step from 0 to 0.1, where the force is 50 times greater, but the factor is that at 0
      bool            was_beyond = false;
      const Landscape cliff
          = valley([](const double a) { return a * a / 2. - 0.1 * a - 1250. * std::pow(a, 4); },
                   [](const double a) { return a - 0.1 - 5000. * std::pow(a, 3); },
                   [](const double a) { return 1. - 15000. * a * a; }, 50.);
      TwoUnknowns unknowns(between_walls(cliff, 0.3, was_beyond), 0., 0.);
      unknowns.solve(by_method(Method::newton));
      EXPECT_FALSE(was_beyond);
    }

    TEST(Newton, MustFindThePlaceInStaticsAndNotOnlyTheBalance)
    {
      // so soft that the forces are within the tolerance long before
      const double k = 1e-4;
      TwoUnknowns  unknowns(valley([=](const double a) { return k * std::cosh(a); },
                                  [=](const double a) { return k * std::sinh(a); },
                                  [=](const double a) { return k * std::cosh(a); }, k),
                            2., 0.);
      EXPECT_EQ(unknowns.solve(by_method(Method::newton, 1e-3)).status, SolveStatus::converged);
      EXPECT_LT(std::abs(unknowns.a()), 4e-3);
    }

    /// a^2 / 20 + a^4 / 4 - F a, for which there are tangents only up to |a| = 2, as if the body
    /// were crushed beyond.
    Landscape
    stiffening(const double F)
    {
      const auto curvature
          = [](const double a) { return std::abs(a) > 2. ? -1. : 0.1 + 3. * a * a; };
      Landscape landscape
          = valley([=](const double a) { return a * a / 20. + std::pow(a, 4) / 4. - F * a; },
                   [=](const double a) { return 0.1 * a + std::pow(a, 3) - F; }, curvature, 1.);
      landscape.convex = landscape.curvature;
      return landscape;
    }

    TEST(Newton, RaisesTheForcesInStagesWhereTheirWholeLeadsNowhere)
    {
      const double      F = 0.15 + std::pow(1.5, 3); // in balance at 1.5
      TwoUnknowns       unknowns(stiffening(F), 0., 0.);
      const SolveReport report = unknowns.solve(by_method(Method::newton));
      EXPECT_EQ(report.status, SolveStatus::converged);
      EXPECT_NEAR(unknowns.a(), 1.5, 1e-8);
      // the first stage moves a by a quarter of the 4 m of the body, were it linear; then the
      // stages double, up to the whole
      const double first = 1. / (F / 0.1);
      EXPECT_EQ(report.load_stages, std::ceil(std::log2(1. + 1. / first)));
    }

    TEST(Newton, ASmallForceNeedsNoStages)
    {
      TwoUnknowns       unknowns(stiffening(0.1), 0., 0.);
      const SolveReport report = unknowns.solve(by_method(Method::newton));
      EXPECT_EQ(report.status, SolveStatus::converged);
      EXPECT_EQ(report.load_stages, 0u);
      EXPECT_NEAR(0.1 * unknowns.a() + std::pow(unknowns.a(), 3), 0.1, 1e-8);
    }

    TEST(Newton, WhoObservesMayStopAStepAndFindsTheStateAsItWas)
    {
      TwoUnknowns unknowns(stiff_hill(), 1e-2, 0.);
      EXPECT_THROW(unknowns.solve(by_method(Method::newton),
                                  [](const SolveReport &now) { return now.iterations < 2; }),
                   Interrupted);
      EXPECT_NEAR(unknowns.a(), 1e-2, 1e-15);
    }

    TEST(QuasiNewton, LeavesAHillToNewtonWhereItMayBeStopped)
    {
      TwoUnknowns stopped(stiff_hill(), 1e-2, 0.);
      EXPECT_THROW(stopped.solve(by_method(Method::quasi_newton),
                                 [](const SolveReport &now) { return now.iterations < 22; }),
                   Interrupted);
      EXPECT_NEAR(stopped.a(), 1e-2, 1e-15);
      TwoUnknowns       unknowns(stiff_hill(), 1e-2, 0.);
      const SolveReport report = unknowns.solve(by_method(Method::quasi_newton));
      EXPECT_EQ(report.status, SolveStatus::converged);
      EXPECT_GT(report.iterations, 21u); // of three metrics
      EXPECT_NEAR(unknowns.a(), 1., 1e-9);
    }

    /// The bar moved at its right end within one step, by what way(rest, t) says.
    struct Pull
    {
      using Way = std::function<dealii::Tensor<1, 3>(const dealii::Point<3> &rest, double t)>;

      Pull(const unsigned int maximum_iterations, const Way &way)
          : scene("set Scene = static\n" + bar + "subsection Handles\n set Names = left, right\n"
                      + held_left + "subsection right\n set Select = boundary 2\nend\nend\n",
                  { "Time/Increments=1", "Solver/Method=newton",
                    "Solver/Maximum iterations=" + std::to_string(maximum_iterations) })
      {
        scene.problem.set_motion(
            "right",
            [this, way](const std::vector<dealii::Point<3>> &rest, const double t)
            {
              times.push_back(t);
              std::vector<dealii::Tensor<1, 3>> ways;
              for (const dealii::Point<3> &x : rest)
                ways.push_back(way(x, t));
              return ways;
            });
        times.clear();
        report = scene.problem.advance();
      }

      bool
      has_been_at(const double time) const
      {
        return std::find(times.begin(), times.end(), time) != times.end();
      }

      std::vector<double> times; ///< for which the motion was asked
      Scene               scene;
      SolveReport         report;
    };

    /// Turned about x, and raised.
    dealii::Tensor<1, 3>
    turn(const dealii::Point<3> &x, const double t)
    {
      const double c = std::cos(2. * t), s = std::sin(2. * t);
      return dealii::Tensor<1, 3>(
          { 0.2 * t, c * x[1] - s * x[2] - x[1] + 0.6 * t, s * x[1] + c * x[2] - x[2] });
    }

    /// From t = 0.3 on beyond the other end.
    dealii::Tensor<1, 3>
    jump(const dealii::Point<3> &, const double t)
    {
      return dealii::Tensor<1, 3>({ t < 0.3 ? 0. : -8., t < 0.3 ? 0. : 0.5, 0. });
    }

    TEST(Newton, HandlesGoHalfTheWayFirstWhereAStepDoesNotConverge)
    {
      const Pull whole(50, turn), halved(4, turn);
      ASSERT_EQ(whole.report.status, SolveStatus::converged);
      ASSERT_GT(whole.report.iterations, 4u);
      EXPECT_FALSE(whole.has_been_at(0.5));
      EXPECT_EQ(halved.report.status, SolveStatus::converged);
      EXPECT_TRUE(halved.has_been_at(0.5));
      EXPECT_LT(
          max_difference(halved.scene.problem.state.positions, whole.scene.problem.state.positions),
          1e-7);
      EXPECT_EQ(halved.scene.problem.state.time, 1.);
    }

    TEST(Newton, HandlesGoNoSmallerPartOfTheWayThanA64th)
    {
      const Pull pull(1, jump);
      EXPECT_FALSE(is_success(pull.report.status));
      EXPECT_TRUE(pull.has_been_at(19. / 64.)); // before the jump,
      EXPECT_TRUE(pull.has_been_at(20. / 64.)); // and behind it
      EXPECT_FALSE(pull.has_been_at(39. / 128.));
      EXPECT_EQ(pull.scene.problem.state.step, 0u);
      EXPECT_EQ(pull.scene.problem.state.positions,
                pull.scene.problem.body.fe_space.rest_positions());
    }

    TEST(Newton, ThePredictionIsTheSolutionWhereTheForcesAreLinear)
    {
      // handles and prescribed weights move at once
      Scene scene("set Scene = static\n" + bar + drag
                      + examples("set Pose functions = 1.2*x; 0.9*y; z\n"
                                 " set Weights = prescribed\n set Prescribed weights = 1-t; t\n"),
                  { "Model/Strain=linear", "Time/Increments=2", "Solver/Method=newton" });
      for (unsigned int step = 0; step < 2; ++step)
      {
        const SolveReport report = scene.problem.advance();
        ASSERT_EQ(report.status, SolveStatus::converged);
        EXPECT_LT(report.residual_history.front(), 1e-10);
      }
    }
  } // namespace
} // namespace Exemplar::Testing
