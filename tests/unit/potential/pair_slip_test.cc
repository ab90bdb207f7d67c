// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/obstacles/obstacle.h>
#include <exemplar/potential/pair_slip.h>

#include <gtest/gtest.h>

#include <random>

namespace Exemplar::Testing
{
  namespace
  {
    SpaceVector3
    any_vector(std::mt19937 &generator)
    {
      std::uniform_real_distribution<double> number(-1., 1.);
      SpaceVector3                           result;
      for (unsigned int c = 0; c < 3; ++c)
        result[c] = number(generator);
      return result;
    }

    /// A pair before and after a step, and the shares of its nearest points.
    struct MovedPair
    {
      explicit MovedPair(std::mt19937 &generator)
      {
        for (unsigned int i = 0; i < 4; ++i)
        {
          before[i] = any_vector(generator);
          now[i]    = before[i] + 0.3 * any_vector(generator);
        }
      }

      PairPoints            before, now;
      std::array<double, 4> coefficients{ { 0.2, 0.5, 0.3, -1. } };
    };
  } // namespace

  TEST(PairMotion, IsNothingForAPairThatTurnsAsAWhole)
  {
    std::mt19937 generator(3);
    for (unsigned int sample = 0; sample < 200; ++sample)
    {
      MovedPair                  pair(generator);
      const dealii::Tensor<2, 3> turn  = rotation_by(0.8 * any_vector(generator));
      const SpaceVector3         shift = any_vector(generator);
      for (unsigned int i = 0; i < 4; ++i)
        pair.now[i] = shift + turn * pair.before[i];
      const auto motion = PairMotion::from(pair.before, pair.now, pair.coefficients);
      ASSERT_TRUE(motion);
      EXPECT_LT(motion->motion().norm(), 1e-13);
      EXPECT_LT((motion->rotation - turn).norm(), 1e-12);
    }
  }

  TEST(PairMotion, HasForcesWithoutSumAndMoment)
  {
    std::mt19937 generator(5);
    for (unsigned int sample = 0; sample < 200; ++sample)
    {
      const MovedPair pair(generator);
      const auto      motion = PairMotion::from(pair.before, pair.now, pair.coefficients);
      ASSERT_TRUE(motion);
      const SpaceVector3 force = any_vector(generator);
      SpaceVector3       sum, moment;
      for (unsigned int i = 0; i < 4; ++i)
      {
        const SpaceVector3 at_point = force * motion->by_point(i);
        sum += at_point;
        moment += dealii::cross_product_3d(pair.now[i], at_point);
      }
      EXPECT_LT(sum.norm(), 1e-12);
      EXPECT_LT(moment.norm(), 1e-12);
    }
  }

  TEST(PairMotion, HasTheDerivativesOfDifferences)
  {
    std::mt19937     generator(7);
    constexpr double h = 1e-6;
    for (unsigned int sample = 0; sample < 100; ++sample)
    {
      MovedPair  pair(generator);
      PairPoints ways;
      for (SpaceVector3 &way : ways)
        way = any_vector(generator);
      const auto at = [&](const double part)
      {
        PairPoints moved = pair.now;
        for (unsigned int i = 0; i < 4; ++i)
          moved[i] += part * ways[i];
        const auto motion = PairMotion::from(pair.before, moved, pair.coefficients);
        return motion->motion() * motion->rotation; // in the axes of the start
      };
      const auto         motion = PairMotion::from(pair.before, pair.now, pair.coefficients);
      const SpaceVector3 slope  = motion->rotation * ((at(h) - at(-h)) / (2. * h));
      SpaceVector3       expected;
      for (unsigned int i = 0; i < 4; ++i)
        expected += motion->by_point(i) * ways[i];
      EXPECT_LT((slope - expected).norm(), 1e-7 * (1. + expected.norm()));
    }
  }

  TEST(PairMotion, IsOpenForPointsInOneLine)
  {
    PairPoints points;
    for (unsigned int i = 0; i < 4; ++i)
      points[i][0] = i;
    EXPECT_FALSE(PairMotion::from(points, points, { { 0.5, 0.5, -0.5, -0.5 } }));
  }
} // namespace Exemplar::Testing
