// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/weight_qp.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace Exemplar::Testing
{
  namespace
  {
    struct Qp
    {
      dealii::FullMatrix<double> H;
      std::vector<double>        c;
    };

    /// H of rank `rank` plus `ridge`.
    Qp
    random_qp(std::mt19937      &generator,
              const unsigned int k,
              const unsigned int rank,
              const double       ridge)
    {
      std::normal_distribution<double> normal;
      Qp                               qp{ dealii::FullMatrix<double>(k, k), {} };
      dealii::FullMatrix<double>       L(k, rank);
      for (unsigned int i = 0; i < k; ++i)
      {
        qp.c.push_back(3. * normal(generator));
        for (unsigned int j = 0; j < rank; ++j)
          L(i, j) = normal(generator);
      }
      L.mTmult(qp.H, L);
      qp.H.diagadd(ridge);
      return qp;
    }

    double
    value(const Qp &qp, const std::vector<double> &w)
    {
      double sum = 0.;
      for (unsigned int i = 0; i < w.size(); ++i)
      {
        sum -= qp.c[i] * w[i];
        for (unsigned int j = 0; j < w.size(); ++j)
          sum += 0.5 * w[i] * qp.H(i, j) * w[j];
      }
      return sum;
    }

    void
    expect_kkt(const Qp                  &qp,
               const WeightQpSolution    &solution,
               const std::vector<double> &lower,
               const std::vector<double> &sums = { 1. })
    {
      ASSERT_TRUE(solution.found);
      const unsigned int  group_size = qp.c.size() / sums.size();
      std::vector<double> found_sums(sums.size());
      double              scale = 1.;
      for (const double c : qp.c)
        scale = std::max(scale, std::abs(c));
      for (unsigned int i = 0; i < qp.c.size(); ++i)
      {
        double g = -qp.c[i] + solution.multipliers[i / group_size];
        for (unsigned int j = 0; j < qp.c.size(); ++j)
          g += qp.H(i, j) * solution.weights[j];
        found_sums[i / group_size] += solution.weights[i];
        EXPECT_GE(solution.weights[i], lower[i]);
        EXPECT_GE(g, -1e-10 * scale);
        if (solution.weights[i] > lower[i])
        {
          EXPECT_NEAR(g, 0., 1e-10 * scale);
        }
      }
      for (unsigned int group = 0; group < sums.size(); ++group)
        EXPECT_NEAR(found_sums[group], sums[group], 1e-12);
    }

    TEST(WeightQp, EqualsBruteForceOverActiveSets)
    {
      std::mt19937 generator(1);
      for (int sample = 0; sample < 200; ++sample)
      {
        const unsigned int        k  = 1 + sample % 5;
        const Qp                  qp = random_qp(generator, k, k, 1e-3);
        const std::vector<double> lower(k, 0.);
        const auto                found = minimize_over_weights(qp.H, qp.c, { 1. }, lower);
        expect_kkt(qp, found, lower);

        // every subset of free weights, the others 0: the least value among the feasible
        double minimum = std::numeric_limits<double>::max();
        for (unsigned int set = 1; set < (1u << k); ++set)
        {
          std::vector<unsigned int> free;
          for (unsigned int i = 0; i < k; ++i)
            if ((set >> i & 1u) != 0)
              free.push_back(i);
          Qp part{ dealii::FullMatrix<double>(free.size(), free.size()), {} };
          for (unsigned int i = 0; i < free.size(); ++i)
          {
            part.c.push_back(qp.c[free[i]]);
            for (unsigned int j = 0; j < free.size(); ++j)
              part.H(i, j) = qp.H(free[i], free[j]);
          }
          const auto w = minimize_over_weights(part.H, part.c, { 1. }, {}).weights;
          if (*std::min_element(w.begin(), w.end()) >= 0.)
            minimum = std::min(minimum, value(part, w));
        }
        EXPECT_NEAR(value(qp, found.weights), minimum, 1e-10 * (1. + std::abs(minimum)));
      }
    }

    TEST(WeightQp, SixtyFourExamplesOfLowRank)
    {
      std::mt19937              generator(2);
      const std::vector<double> lower(64, 0.);
      for (int sample = 0; sample < 5; ++sample)
      {
        const Qp qp = random_qp(generator, 64, 10, 1e-6);
        expect_kkt(qp, minimize_over_weights(qp.H, qp.c, { 1. }, lower), lower);
      }
    }

    TEST(WeightQp, AnyStartLeadsToTheMinimiser)
    {
      std::mt19937              generator(5);
      const std::vector<double> lower(8, 0.), sums = { 1., 0.5 };
      for (int sample = 0; sample < 50; ++sample)
      {
        const Qp   qp   = random_qp(generator, 8, 8, 1e-3);
        const auto cold = minimize_over_weights(qp.H, qp.c, sums, lower);
        // inside, on a face, at a corner, and there already
        for (const std::vector<double> &start :
             { std::vector<double>{ 0.25, 0.25, 0.25, 0.25, 0.2, 0.1, 0.1, 0.1 },
               std::vector<double>{ 0.5, 0., 0.5, 0., 0., 0., 0.25, 0.25 },
               std::vector<double>{ 0., 0., 0., 1., 0.5, 0., 0., 0. }, cold.weights })
        {
          const auto warm = minimize_over_weights(qp.H, qp.c, sums, lower, start);
          expect_kkt(qp, warm, lower, sums);
          for (unsigned int i = 0; i < 8; ++i)
            EXPECT_NEAR(warm.weights[i], cold.weights[i], 1e-9);
        }
      }
    }

    TEST(WeightQp, GroupsKeepTheirOwnSums)
    {
      std::mt19937              generator(4);
      const std::vector<double> lower(12, 0.), sums = { 1., 0.5, 2. };
      for (int sample = 0; sample < 50; ++sample)
      {
        const Qp qp = random_qp(generator, 12, 12, 1e-3);
        expect_kkt(qp, minimize_over_weights(qp.H, qp.c, sums, lower), lower, sums);
      }
    }

    TEST(WeightQp, BoundsOfAStep)
    {
      // w + dw >= 0 as bounds on dw, which sums to 0
      std::mt19937              generator(3);
      const Qp                  qp = random_qp(generator, 4, 4, 1e-3);
      const std::vector<double> w  = { 0.5, 0., 0.5, 0. };
      std::vector<double>       lower;
      for (const double weight : w)
        lower.push_back(-weight);
      const auto step = minimize_over_weights(qp.H, qp.c, { 0. }, lower);
      ASSERT_TRUE(step.found);
      double sum = 0.;
      for (unsigned int i = 0; i < 4; ++i)
      {
        EXPECT_GE(w[i] + step.weights[i], 0.);
        sum += step.weights[i];
      }
      EXPECT_NEAR(sum, 0., 1e-14);
    }

    TEST(WeightQp, RefusesAnIndefiniteMatrix)
    {
      dealii::FullMatrix<double> H(2, 2);
      H(0, 0) = H(1, 1) = -1.;
      EXPECT_FALSE(minimize_over_weights(H, { 1., 2. }, { 1. }, {}).found);
      // indefinite, but positive definite on differences: that is enough
      H(0, 0) = H(1, 1) = 0.;
      H(0, 1) = H(1, 0) = -1.;
      EXPECT_TRUE(minimize_over_weights(H, { 1., 2. }, { 1. }, {}).found);
    }
  } // namespace
} // namespace Exemplar::Testing
