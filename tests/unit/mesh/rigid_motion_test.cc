// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/rigid_motion.h>

#include "matrices.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    using Points = std::vector<dealii::Point<3>>;

    const double degree = M_PI / 180.;

    dealii::Point<3>
    random_point(std::mt19937 &generator)
    {
      std::normal_distribution<double> normal;
      const double                     x = normal(generator), y = normal(generator);
      return { x, y, normal(generator) };
    }

    Points
    random_points(const unsigned int n, const unsigned int seed)
    {
      std::mt19937 generator(seed);
      Points       points;
      for (unsigned int i = 0; i < n; ++i)
        points.push_back(random_point(generator));
      return points;
    }

    Points
    moved(const RigidMotion &motion, const Points &points)
    {
      Points result;
      for (const auto &x : points)
        result.push_back(motion(x));
      return result;
    }

    double
    max_distance(const Points &a, const Points &b)
    {
      double maximum = 0.;
      for (std::size_t i = 0; i < a.size(); ++i)
        maximum = std::max(maximum, a[i].distance(b[i]));
      return maximum;
    }

    Points
    at(const RigidPath &path, Points points, const double progress)
    {
      for (unsigned int i = 0; i < points.size(); ++i)
        points[i] += path.displacement(i, progress);
      return points;
    }

    /// Greatest change of the distance of two points.
    double
    distortion(const Points &a, const Points &b)
    {
      double maximum = 0.;
      for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
          maximum = std::max(maximum, std::abs(a[i].distance(a[j]) - b[i].distance(b[j])));
      return maximum;
    }

    double
    angle_between(const Points &points, const Points &targets)
    {
      return axis_and_angle(best_rigid_motion(points, targets).rotation).angle;
    }

    const Vector3<double> oblique = { { 1., -2., 0.5 } };

    RigidMotion
    turn_by(const double angle)
    {
      return { { 0.1, 0.2, 0.3 }, { 2., -1., 5. }, rotation_about(oblique, angle) };
    }

    TEST(RigidMotion, FindsARigidMotionOfAnyAngle)
    {
      const Points points = random_points(7, 1);
      for (const double degrees : { 0., 1e-5, 20., 157., 179.999, 180. })
      {
        const Points      targets = moved(turn_by(degrees * degree), points);
        const RigidMotion motion  = best_rigid_motion(points, targets);
        EXPECT_LT(max_distance(moved(motion, points), targets), 1e-14 * 10) << degrees;
        EXPECT_NEAR(axis_and_angle(motion.rotation).angle, degrees * degree, 1e-14 * 10);
      }
    }

    TEST(RigidMotion, IsNearestAmongItsNeighbours)
    {
      const Points points = random_points(7, 2), targets = random_points(7, 3);
      const auto   misfit = [&](const RigidMotion &motion)
      {
        double sum = 0.;
        for (std::size_t i = 0; i < points.size(); ++i)
          sum += (motion(points[i]) - targets[i]).norm_square();
        return sum;
      };
      const RigidMotion best = best_rigid_motion(points, targets);
      for (int d = 0; d < 3; ++d)
        for (const double step : { -1e-3, 1e-3 })
        {
          Vector3<double> axis{};
          axis[d]            = 1.;
          RigidMotion turned = best, shifted = best;
          turned.rotation = rotation_about(axis, step) * best.rotation;
          shifted.to[d] += step;
          EXPECT_LT(misfit(best), misfit(turned));
          EXPECT_LT(misfit(best), misfit(shifted));
        }
    }

    TEST(RigidMotion, AxisAndAngleGiveTheRotationBack)
    {
      std::mt19937 generator(4);
      for (const double angle : { 1e-9, 1e-3, 1., 3., M_PI - 1e-6, M_PI })
        for (int sample = 0; sample < 20; ++sample)
        {
          const auto            axis = random_point(generator);
          const Matrix3<double> Q    = rotation_about({ { axis[0], axis[1], axis[2] } }, angle);
          const AxisAngle       turn = axis_and_angle(Q);
          const Matrix3<double> again
              = rotation_about({ { turn.axis[0], turn.axis[1], turn.axis[2] } }, turn.angle);
          EXPECT_LT(max_difference(again, Q), 1e-14) << angle;
          EXPECT_NEAR(turn.angle, angle, 1e-14 * 10);
        }
      EXPECT_EQ(axis_and_angle(identity_matrix<double>()).angle, 0.);
    }

    TEST(RigidMotion, TheWayOfAHalfTurnDoesNotDependOnRounding)
    {
      const auto axis = axis_and_angle(rotation_about({ { 1., -2., 0.5 } }, M_PI)).axis;
      for (const double sign : { -1., 1. })
        for (const double noise : { -1e-14, 0., 1e-14 })
        {
          const auto now
              = axis_and_angle(rotation_about({ { sign, -2. * sign, 0.5 * sign } }, M_PI + noise));
          EXPECT_LT((now.axis - axis).norm(), 1e-12);
          EXPECT_NEAR(now.angle, M_PI, 1e-13);
        }
      EXPECT_GT(axis[0], 0.);
    }

    TEST(RigidMotion, OnePointDoesNotTurn)
    {
      const Points      points = { { 1., 2., 3. } }, targets = { { -5., 0.1, 7. } };
      const RigidMotion motion = best_rigid_motion(points, targets);
      EXPECT_EQ(max_difference(motion.rotation, identity_matrix<double>()), 0.);
      EXPECT_EQ(motion(points[0]).distance(targets[0]), 0.);
    }

    TEST(RigidMotion, PointsOnALineTurnNoFurtherThanTheLine)
    {
      const dealii::Tensor<1, 3> u({ 2., 1., -1. }), v({ 0.5, -3., 1. });
      const double               angle = std::acos(u * v / u.norm() / v.norm());
      for (const Points &points : { Points{ { 1., 2., 3. }, dealii::Point<3>(1., 2., 3.) + u },
                                    Points{ { 1., 2., 3. },
                                            dealii::Point<3>(1., 2., 3.) + u,
                                            dealii::Point<3>(1., 2., 3.) - 0.3 * u } })
      {
        Points targets;
        for (const auto &x : points)
          targets.push_back(dealii::Point<3>(4., 0., 1.)
                            + ((x - points[0]) * u / u.norm_square() * u.norm() / v.norm()) * v);
        const RigidMotion motion = best_rigid_motion(points, targets);
        EXPECT_TRUE(are_collinear(points));
        EXPECT_LT(max_distance(moved(motion, points), targets), 1e-14 * 10);
        EXPECT_NEAR(axis_and_angle(motion.rotation).angle, angle, 1e-14 * 10);
        EXPECT_NEAR(angle_between(points, points), 0., 1e-14);

        const Points      reversed  = moved({ points[0],
                                              { 0., 0., 0. },
                                              { { { -1., 0., 0. }, { 0., -1., 0. }, { 0., 0., -1. } } } },
                                            points);
        const RigidMotion half_turn = best_rigid_motion(points, reversed);
        EXPECT_LT(max_distance(moved(half_turn, points), reversed), 1e-14 * 10);
        EXPECT_NEAR(axis_and_angle(half_turn.rotation).angle, M_PI, 1e-14);
        EXPECT_NEAR(determinant(half_turn.rotation), 1., 1e-14);
      }
    }

    TEST(RigidMotion, RoundedCoordinatesOfALineDoNotTurnItAboutItself)
    {
      std::mt19937 generator(5);
      Points       points, targets;
      for (int i = 0; i < 6; ++i)
      {
        const dealii::Point<3> x(i, 0., 0.), y(0., i, 0.);
        points.push_back(x + 1e-6 * (random_point(generator) - dealii::Point<3>()));
        targets.push_back(y + 1e-6 * (random_point(generator) - dealii::Point<3>()));
      }
      EXPECT_NEAR(angle_between(points, targets), M_PI / 2., 1e-5);
    }

    TEST(RigidMotion, PointsInAPlaneTurnAsOneBody)
    {
      Points points = random_points(6, 6);
      for (auto &x : points)
        x[2] = 0.25 * x[0] - x[1];
      for (const double degrees : { 30., 157., 180. })
      {
        const Points targets = moved(turn_by(degrees * degree), points);
        EXPECT_FALSE(are_collinear(points));
        EXPECT_NEAR(angle_between(points, targets), degrees * degree, 1e-13);
        EXPECT_LT(max_distance(moved(best_rigid_motion(points, targets), points), targets), 1e-13);
      }
    }

    TEST(RigidPath, GoesRigidlyToARigidPose)
    {
      const Points points = random_points(8, 7);
      for (const double degrees : { 0., 40., 157., 180. })
      {
        const RigidMotion motion  = turn_by(degrees * degree);
        const Points      targets = moved(motion, points);
        const RigidPath   path(points, targets);
        EXPECT_EQ(max_distance(at(path, points, 0.), points), 0.);
        EXPECT_LT(max_distance(at(path, points, 1.), targets), 1e-13);
        const auto start = centroid(points), end = centroid(targets);
        for (const double s : { -0.3, 0.1, 0.5, 0.9, 1.4 })
        {
          const Points now = at(path, points, s);
          EXPECT_LT(distortion(now, points), 1e-12);
          EXPECT_LT(centroid(now).distance(start + s * (end - start)), 1e-13);
        }
      }
    }

    TEST(RigidPath, HalfWayIsHalfTheAngle)
    {
      const Points    points = random_points(8, 8);
      const RigidPath path(points, moved(turn_by(157. * degree), points));
      EXPECT_NEAR(angle_between(points, at(path, points, 0.5)), 78.5 * degree, 1e-13);
      EXPECT_NEAR(angle_between(points, at(path, points, -0.1)), 15.7 * degree, 1e-13);
      const Points half = moved({ centroid(points), centroid(at(path, points, 0.5)),
                                  rotation_about(oblique, 78.5 * degree) },
                                points);
      EXPECT_LT(max_distance(at(path, points, 0.5), half), 1e-13);
    }

    TEST(RigidPath, AddsTheRemainderInProportionTurnedAlong)
    {
      // of points enlarged by 1.3 and turned: enlarged by 1 + 0.3 s on the way, and turned by s
      const Points points  = random_points(8, 9);
      Points       targets = moved(turn_by(2.), points);
      for (auto &y : targets)
        y = dealii::Point<3>() + 1.3 * y;
      const RigidPath path(points, targets);
      EXPECT_LT(max_distance(at(path, points, 1.), targets), 1e-13);
      const auto start = centroid(points), end = centroid(targets);
      for (const double s : { -0.5, 0.25, 0.5, 0.75, 2. })
      {
        Points enlarged;
        for (const auto &x : points)
          enlarged.push_back(start + (1. + 0.3 * s) * (x - start));
        const RigidMotion part
            = { start, start + s * (end - start), rotation_about(oblique, 2. * s) };
        EXPECT_LT(max_distance(at(path, points, s), moved(part, enlarged)), 1e-13) << s;
      }
    }

    TEST(RigidPath, ReachesAnyPoseOfFewOrCrushedPoints)
    {
      for (const unsigned int n : { 1u, 2u, 3u, 4u, 9u })
      {
        const Points    points = random_points(n, 20 + n), targets = random_points(n, 30 + n);
        const RigidPath path(points, targets), to_one_place(points, Points(n, targets[0]));
        EXPECT_EQ(max_distance(at(path, points, 0.), points), 0.);
        EXPECT_LT(max_distance(at(path, points, 1.), targets), 1e-13);
        EXPECT_LT(max_distance(at(to_one_place, points, 1.), Points(n, targets[0])), 1e-13);
      }
      const Points points = random_points(1, 40), targets = random_points(1, 41);
      const auto   half = at(RigidPath(points, targets), points, 0.5);
      EXPECT_LT(half[0].distance(points[0] + 0.5 * (targets[0] - points[0])), 1e-15);
    }
  } // namespace
} // namespace Exemplar::Testing
