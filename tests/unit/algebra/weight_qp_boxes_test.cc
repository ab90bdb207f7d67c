// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/dense.h>
#include <exemplar/algebra/weight_qp.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

// Weights between two bounds and without a sum, with and without kinks, against all active sets one
// after the other.

namespace Exemplar::Testing
{
  namespace
  {
    using Numbers = std::vector<double>;

    struct BoxQp
    {
      dealii::FullMatrix<double> H;
      Numbers                    c;
      WeightLimits               limits;
    };

    BoxQp
    random_box(std::mt19937 &generator, const unsigned int k, const bool has_kinks)
    {
      std::normal_distribution<double>       normal;
      std::uniform_real_distribution<double> uniform;
      BoxQp                                  qp;
      dealii::FullMatrix<double>             L(k, k);
      for (unsigned int i = 0; i < k; ++i)
      {
        qp.c.push_back(2. * normal(generator));
        for (unsigned int j = 0; j < k; ++j)
          L(i, j) = normal(generator);
        qp.limits.lower.push_back(-0.3 * uniform(generator));
        qp.limits.upper.push_back(qp.limits.lower[i] + 0.2 + uniform(generator));
        if (!has_kinks)
          continue;
        // at a bound as often as between them
        const double part[] = { 0., uniform(generator), 1. };
        const double kink   = part[generator() % 3];
        qp.limits.kinks.push_back(
            kink == 1. ? qp.limits.upper[i]
                       : qp.limits.lower[i] + kink * (qp.limits.upper[i] - qp.limits.lower[i]));
        qp.limits.yields.push_back(2. * uniform(generator));
      }
      qp.H.reinit(k, k);
      L.mTmult(qp.H, L);
      qp.H.diagadd(1e-2);
      return qp;
    }

    double
    value(const BoxQp &qp, const Numbers &w)
    {
      double sum = 0.;
      for (unsigned int i = 0; i < w.size(); ++i)
      {
        sum -= qp.c[i] * w[i];
        for (unsigned int j = 0; j < w.size(); ++j)
          sum += 0.5 * w[i] * qp.H(i, j) * w[j];
        if (!qp.limits.kinks.empty())
          sum += qp.limits.yields[i] * std::abs(w[i] - qp.limits.kinks[i]);
      }
      return sum;
    }

    enum Place : unsigned int
    {
      at_lower,
      at_upper,
      at_kink,
      above_kink,
      below_kink,
      n_places
    };

    /// The stationary point with each weight at its place, which others than free ones have for sure.
    Numbers
    stationary_point(const BoxQp &qp, const std::vector<unsigned int> &places)
    {
      const bool                has_kinks = !qp.limits.kinks.empty();
      Numbers                   w(qp.c.size(), 0.), right;
      std::vector<unsigned int> free;
      for (unsigned int i = 0; i < w.size(); ++i)
        if (places[i] == at_lower || places[i] == at_upper)
          w[i] = places[i] == at_lower ? qp.limits.lower[i] : qp.limits.upper[i];
        else if (places[i] == at_kink && has_kinks)
          w[i] = qp.limits.kinks[i];
        else
          free.push_back(i);
      dealii::FullMatrix<double> A(free.size(), free.size());
      for (unsigned int i = 0; i < free.size(); ++i)
      {
        const unsigned int row  = free[i];
        const double       side = places[row] == above_kink ? 1. : -1.;
        right.push_back(qp.c[row] - (has_kinks ? side * qp.limits.yields[row] : 0.));
        for (unsigned int j = 0; j < w.size(); ++j)
          right[i] -= qp.H(row, j) * w[j];
        for (unsigned int j = 0; j < free.size(); ++j)
          A(i, j) = qp.H(row, free[j]);
      }
      EXPECT_TRUE(solve_by_cholesky(A, right));
      for (unsigned int i = 0; i < free.size(); ++i)
        w[free[i]] = right[i];
      return w;
    }

    /// The least value among the stationary points of all active sets that are within the bounds.
    double
    least_value(const BoxQp &qp)
    {
      const unsigned int k      = qp.c.size();
      double             least  = std::numeric_limits<double>::max();
      unsigned int       n_sets = 1;
      for (unsigned int i = 0; i < k; ++i)
        n_sets *= n_places;
      for (unsigned int set = 0; set < n_sets; ++set)
      {
        std::vector<unsigned int> places;
        for (unsigned int i = 0, rest = set; i < k; ++i, rest /= n_places)
          places.push_back(rest % n_places);
        const Numbers w         = stationary_point(qp, places);
        bool          is_within = true;
        for (unsigned int i = 0; i < k; ++i)
          is_within = is_within && w[i] >= qp.limits.lower[i] - 1e-12
                      && w[i] <= qp.limits.upper[i] + 1e-12;
        if (is_within)
          least = std::min(least, value(qp, w));
      }
      return least;
    }

    void
    expect_least(const BoxQp &qp, const WeightQpSolution &found, const double least)
    {
      ASSERT_TRUE(found.found);
      EXPECT_TRUE(found.multipliers.empty());
      ASSERT_EQ(found.weights.size(), qp.c.size());
      for (unsigned int i = 0; i < qp.c.size(); ++i)
      {
        EXPECT_GE(found.weights[i], qp.limits.lower[i]);
        EXPECT_LE(found.weights[i], qp.limits.upper[i]);
      }
      EXPECT_NEAR(value(qp, found.weights), least, 1e-10 * (1. + std::abs(least)));
    }

    TEST(WeightQpBoxes, EqualBruteForceOverActiveSets)
    {
      std::mt19937 generator(11);
      unsigned int n_at_upper = 0;
      for (int sample = 0; sample < 200; ++sample)
      {
        const unsigned int k     = 1 + sample % 4;
        const BoxQp        qp    = random_box(generator, k, sample % 2 == 1);
        const auto         found = minimize_over_weights(qp.H, qp.c, {}, qp.limits);
        const double       least = least_value(qp);
        expect_least(qp, found, least);
        for (unsigned int i = 0; i < k; ++i)
          n_at_upper += found.weights[i] == qp.limits.upper[i] ? 1 : 0;
        Numbers start;
        for (unsigned int i = 0; i < k; ++i)
          start.push_back(0.5 * (qp.limits.lower[i] + qp.limits.upper[i]));
        for (const Numbers &from : { qp.limits.lower, start, qp.limits.upper,
                                     qp.limits.kinks.empty() ? found.weights : qp.limits.kinks })
          expect_least(qp, minimize_over_weights(qp.H, qp.c, {}, qp.limits, from), least);
      }
      EXPECT_GT(n_at_upper, 50u); // exactly, without rounding
    }

    TEST(WeightQpBoxes, EqualBoundsLeaveNoOther)
    {
      std::mt19937 generator(12);
      BoxQp        qp = random_box(generator, 4, false);
      qp.limits.upper = qp.limits.lower;
      EXPECT_EQ(minimize_over_weights(qp.H, qp.c, {}, qp.limits).weights, qp.limits.lower);
    }

    TEST(WeightQpBoxes, SixtyFourKeys)
    {
      std::mt19937 generator(13);
      for (int sample = 0; sample < 6; ++sample)
      {
        const BoxQp            qp    = random_box(generator, 64, sample % 2 == 1);
        const WeightQpSolution found = minimize_over_weights(qp.H, qp.c, {}, qp.limits);
        ASSERT_TRUE(found.found);
        // nothing near it within the bounds is less
        std::uniform_real_distribution<double> uniform(-1., 1.);
        const double                           least = value(qp, found.weights);
        for (int trial = 0; trial < 200; ++trial)
        {
          Numbers w = found.weights;
          for (unsigned int i = 0; i < 64; ++i)
            w[i] = std::clamp(w[i] + std::pow(0.1, double(trial % 6)) * uniform(generator),
                              qp.limits.lower[i], qp.limits.upper[i]);
          EXPECT_GE(value(qp, w), least - 1e-10 * std::abs(least));
        }
      }
    }
  } // namespace
} // namespace Exemplar::Testing
