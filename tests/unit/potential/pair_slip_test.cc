// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/obstacles/obstacle.h>
#include <exemplar/potential/pair_slip.h>

#include <gtest/gtest.h>

#include <random>

namespace Exemplar::Testing
{
  namespace
  {
    constexpr std::array<double, 4> coefficients{ { 0.2, 0.5, 0.3, -1. } };

    SpaceVector3
    any_vector(std::mt19937 &generator)
    {
      std::uniform_real_distribution<double> number(-1., 1.);
      SpaceVector3                           result;
      for (unsigned int c = 0; c < 3; ++c)
        result[c] = number(generator);
      return result;
    }

    PairPoints
    any_pair(std::mt19937 &generator)
    {
      PairPoints points;
      for (SpaceVector3 &point : points)
        point = any_vector(generator);
      return points;
    }

    SpaceVector3
    slip(const PairPoints &before, const PairPoints &now)
    {
      const auto   by_points = slip_of_pair(now, coefficients);
      SpaceVector3 sum;
      for (unsigned int i = 0; i < 4; ++i)
        sum += by_points[i] * (now[i] - before[i]);
      return sum;
    }
  } // namespace

  TEST(SlipOfPair, IsNothingForAPairThatTurnsAsAWhole)
  {
    std::mt19937 generator(3);
    for (unsigned int sample = 0; sample < 200; ++sample)
    {
      const PairPoints   before = any_pair(generator);
      const SpaceVector3 shift = any_vector(generator), axis = any_vector(generator);
      const auto         slip_of_turn = [&](const double angle)
      {
        PairPoints now;
        for (unsigned int i = 0; i < 4; ++i)
          now[i] = shift + rotation_by(angle * axis) * before[i];
        return slip(before, now).norm();
      };
      // the slip of small turns falls with their square
      EXPECT_LT(slip_of_turn(1e-4), 1e-6);
      EXPECT_LT(slip_of_turn(1e-5), 1e-8);
    }
  }

  TEST(SlipOfPair, HasForcesWithoutSumAndMoment)
  {
    std::mt19937 generator(5);
    for (unsigned int sample = 0; sample < 200; ++sample)
    {
      const PairPoints   points    = any_pair(generator);
      const auto         by_points = slip_of_pair(points, coefficients);
      const SpaceVector3 force     = any_vector(generator);
      SpaceVector3       sum, moment;
      for (unsigned int i = 0; i < 4; ++i)
      {
        const SpaceVector3 at_point = force * by_points[i];
        sum += at_point;
        moment += dealii::cross_product_3d(points[i], at_point);
      }
      EXPECT_LT(sum.norm(), 1e-11);
      EXPECT_LT(moment.norm(), 1e-11);
    }
  }

  TEST(SlipOfPair, IsTheMotionOfPartsThatSlideFarPastEachOther)
  {
    // a point above a triangle slides from far away: the slip is that way but for the distance over the triangle's size
    constexpr double   distance = 1e-3;
    const PairPoints   now{ { SpaceVector3({ 1., 0., 0. }), SpaceVector3({ -0.5, 0.8, 0. }),
                              SpaceVector3({ -0.5, -0.8, 0. }),
                              SpaceVector3({ -0.2, 0.16, distance }) } };
    const SpaceVector3 way({ 3., -2., 0. });
    PairPoints         before = now;
    before[3] -= way;
    EXPECT_LT((slip(before, now) + way).norm(), 2. * distance * way.norm());
  }

  TEST(SlipOfPair, IsOpenForPointsInOneLine)
  {
    PairPoints points;
    for (unsigned int i = 0; i < 4; ++i)
      points[i][0] = i;
    EXPECT_TRUE(slip_of_pair(points, { { 0.5, 0.5, -0.5, -0.5 } }).empty());
  }
} // namespace Exemplar::Testing
