// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/dense.h>
#include <exemplar/algebra/weight_qp.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

// Weights with a price of leaving where they are, against all active sets one after the other.

namespace Exemplar::Testing
{
  namespace
  {
    using Numbers = std::vector<double>;

    struct PricedQp
    {
      dealii::FullMatrix<double> H;
      Numbers                    c;
      WeightLimits               limits;
    };

    Numbers
    derivative(const PricedQp &qp, const Numbers &w)
    {
      Numbers g(w.size());
      for (unsigned int i = 0; i < w.size(); ++i)
      {
        g[i] = -qp.c[i];
        for (unsigned int j = 0; j < w.size(); ++j)
          g[i] += qp.H(i, j) * w[j];
      }
      return g;
    }

    double
    value(const PricedQp &qp, const Numbers &w)
    {
      const Numbers g   = derivative(qp, w);
      double        sum = 0.;
      for (unsigned int i = 0; i < w.size(); ++i)
        sum += 0.5 * w[i] * (g[i] - qp.c[i])
               + qp.limits.yields[i] * std::abs(w[i] - qp.limits.kinks[i]);
      return sum;
    }

    /// On the simplex, with about every third weight at zero, as `kind` is 1, or at a corner, as it is 2.
    Numbers
    random_weights(std::mt19937 &generator, const unsigned int k, const int kind)
    {
      std::uniform_real_distribution<double> uniform;
      Numbers                                w(k, 0.);
      if (kind != 2)
        for (double &weight : w)
          weight = kind == 1 && generator() % 3 == 0 ? 0. : uniform(generator);
      const double sum = std::accumulate(w.begin(), w.end(), 0.);
      if (sum == 0.)
        w[generator() % k] = 1.;
      else
        for (double &weight : w)
          weight /= sum;
      return w;
    }

    PricedQp
    random_qp(std::mt19937 &generator, const unsigned int k, const unsigned int rank)
    {
      std::normal_distribution<double> normal;
      PricedQp                         qp{ dealii::FullMatrix<double>(k, k), {}, Numbers(k, 0.) };
      dealii::FullMatrix<double>       L(k, rank);
      for (unsigned int i = 0; i < k; ++i)
      {
        qp.c.push_back(normal(generator));
        for (unsigned int j = 0; j < rank; ++j)
          L(i, j) = normal(generator);
      }
      L.mTmult(qp.H, L);
      qp.limits.kinks = random_weights(generator, k, generator() % 3);
      qp.limits.yields.resize(k, 0.);
      const double yield = std::pow(10., static_cast<double>(generator() % 4) - 2.);
      for (double &s : qp.limits.yields)
        s = yield * (generator() % 2 == 0 ? 1. : 0.3);
      return qp;
    }

    /// The minimiser with weights at zero (0), stuck (1), below (2) and above (3) their kinks; or empty.
    Numbers
    minimiser_of(const PricedQp &qp, const std::vector<unsigned int> &places)
    {
      Numbers                   w(qp.c.size(), 0.), c = qp.c;
      std::vector<unsigned int> free;
      for (unsigned int i = 0; i < w.size(); ++i)
      {
        w[i] = places[i] == 1 ? qp.limits.kinks[i] : 0.;
        if (places[i] > 1)
          free.push_back(i);
        c[i] -= places[i] == 3 ? qp.limits.yields[i] : places[i] == 2 ? -qp.limits.yields[i] : 0.;
      }
      const double rest = 1. - std::accumulate(w.begin(), w.end(), 0.);
      if (free.empty())
        return std::abs(rest) < 1e-12 ? w : Numbers();
      PricedQp part = qp;
      part.H.reinit(free.size(), free.size());
      part.c.clear();
      for (unsigned int i = 0; i < free.size(); ++i)
      {
        part.c.push_back(c[free[i]]);
        for (unsigned int j = 0; j < w.size(); ++j)
          part.c[i] -= qp.H(free[i], j) * w[j];
        for (unsigned int j = 0; j < free.size(); ++j)
          part.H(i, j) = qp.H(free[i], free[j]);
      }
      const WeightQpSolution found = minimize_over_weights(part.H, part.c, { rest }, {});
      for (unsigned int i = 0; found.found && i < free.size(); ++i)
        w[free[i]] = found.weights[i];
      return found.found ? w : Numbers();
    }

    double
    least_value(const PricedQp &qp)
    {
      const unsigned int        k = qp.c.size();
      std::vector<unsigned int> places(k);
      double                    least = std::numeric_limits<double>::max();
      for (unsigned int set = 0; set < 1u << 2 * k; ++set)
      {
        for (unsigned int i = 0; i < k; ++i)
          places[i] = set >> 2 * i & 3u;
        const Numbers w = minimiser_of(qp, places);
        if (!w.empty() && *std::min_element(w.begin(), w.end()) > -1e-12)
          least = std::min(least, value(qp, w));
      }
      return least;
    }

    /// The conditions of Karush, Kuhn and Tucker, up to a part of the greatest number in them.
    void
    expect_minimum(const PricedQp         &qp,
                   const WeightQpSolution &solution,
                   const Numbers          &sums     = { 1. },
                   const double            accuracy = 1e-9)
    {
      ASSERT_TRUE(solution.found);
      const Numbers g          = derivative(qp, solution.weights);
      const auto    group_size = static_cast<unsigned int>(qp.c.size() / sums.size());
      const double  scale      = 1. + std::abs(*std::max_element(qp.c.begin(), qp.c.end()))
                           + *std::max_element(qp.limits.yields.begin(), qp.limits.yields.end());
      Numbers found_sums(sums.size());
      for (unsigned int i = 0; i < qp.c.size(); ++i)
      {
        const double w = solution.weights[i], kink = qp.limits.kinks[i];
        const double slope = g[i] + solution.multipliers[i / group_size];
        found_sums[i / group_size] += w;
        EXPECT_GE(w, qp.limits.lower[i]);
        const double up   = slope + (w >= kink ? 1. : -1.) * qp.limits.yields[i];
        const double down = slope + (w > kink ? 1. : -1.) * qp.limits.yields[i];
        EXPECT_GE(up, -accuracy * scale);
        if (w > qp.limits.lower[i])
        {
          EXPECT_LE(down, accuracy * scale);
        }
      }
      for (unsigned int group = 0; group < sums.size(); ++group)
        EXPECT_NEAR(found_sums[group], sums[group], 1e-12);
    }

    TEST(WeightQpKinks, EqualBruteForceOverActiveSets)
    {
      std::mt19937 generator(1);
      unsigned int n_stuck = 0, n_zero = 0, n_free = 0;
      for (int sample = 0; sample < 400; ++sample)
      {
        const unsigned int k  = 1 + sample % 4;
        PricedQp           qp = random_qp(generator, k, k);
        qp.H.diagadd(1e-3);
        const WeightQpSolution found = minimize_over_weights(qp.H, qp.c, { 1. }, qp.limits);
        expect_minimum(qp, found);
        const double least = least_value(qp);
        EXPECT_NEAR(value(qp, found.weights), least, 1e-10 * (1. + std::abs(least)));
        for (unsigned int i = 0; i < k; ++i)
          ++(found.weights[i] == qp.limits.kinks[i] ? n_stuck
             : found.weights[i] == 0.               ? n_zero
                                                    : n_free);
      }
      EXPECT_GT(n_stuck, 200u);
      EXPECT_GT(n_zero, 50u);
      EXPECT_GT(n_free, 200u);
    }

    TEST(WeightQpKinks, NearlyDependentExamplesToo)
    {
      std::mt19937 generator(2);
      for (int sample = 0; sample < 400; ++sample)
      {
        const unsigned int k  = 2 + sample % 3;
        PricedQp           qp = random_qp(generator, k, 1);
        qp.H.diagadd(sample % 2 == 0 ? 1e-9 : 1e-6);
        const WeightQpSolution found = minimize_over_weights(qp.H, qp.c, { 1. }, qp.limits);
        expect_minimum(qp, found);
        const double least = least_value(qp);
        EXPECT_NEAR(value(qp, found.weights), least, 1e-9 * (1. + std::abs(least)));
      }
    }

    TEST(WeightQpKinks, TiesAndIntegersToo)
    {
      // numbers that are the same, or meet their conditions exactly
      std::mt19937 generator(3);
      for (int sample = 0; sample < 2000; ++sample)
      {
        const unsigned int k = 2 + sample % 3;
        PricedQp           qp{ dealii::FullMatrix<double>(k, k), {}, Numbers(k, 0.) };
        for (unsigned int i = 0; i < k; ++i)
        {
          qp.H(i, i) = 1. + static_cast<double>(generator() % 2);
          qp.c.push_back(0.5 * static_cast<double>(generator() % 5));
          qp.limits.yields.push_back(0.25 * static_cast<double>(generator() % 4));
          qp.limits.kinks.push_back(0.);
        }
        for (int quarter = 0; quarter < 4; ++quarter)
          qp.limits.kinks[generator() % k] += 0.25;
        const WeightQpSolution found = minimize_over_weights(qp.H, qp.c, { 1. }, qp.limits);
        expect_minimum(qp, found);
        EXPECT_NEAR(value(qp, found.weights), least_value(qp), 1e-12);
      }
    }

    TEST(WeightQpKinks, TiesOfDependentExamplesEndToo)
    {
      std::mt19937 generator(77);
      for (int sample = 0; sample < 20000; ++sample)
      {
        const unsigned int         k = 2 + generator() % 12, rank = 1 + generator() % k;
        PricedQp                   qp{ dealii::FullMatrix<double>(k, k), {}, Numbers(k, 0.) };
        dealii::FullMatrix<double> L(k, rank);
        Numbers                    start(k, 0.);
        for (unsigned int i = 0; i < k; ++i)
        {
          for (unsigned int j = 0; j < rank; ++j)
            L(i, j) = static_cast<double>(generator() % 3) - 1.;
          qp.c.push_back(0.25 * static_cast<double>(generator() % 5));
          qp.limits.yields.push_back(0.25 * static_cast<double>(generator() % 4));
        }
        L.mTmult(qp.H, L);
        qp.H.diagadd(generator() % 2 == 0 ? 1e-9 : 1e-3);
        qp.limits.kinks.resize(k, 0.);
        for (int quarter = 0; quarter < 4; ++quarter)
          qp.limits.kinks[generator() % k] += 0.25;
        for (int tenth = 0; tenth < 10; ++tenth)
          start[generator() % k] += 0.1;
        expect_minimum(qp, minimize_over_weights(qp.H, qp.c, { 1. }, qp.limits, start), { 1. },
                       1e-7);
      }
    }

    TEST(WeightQpKinks, ManyWeightsInGroupsFromAnyStart)
    {
      std::mt19937  generator(4);
      const Numbers sums = { 1., 1., 1. };
      for (int sample = 0; sample < 100; ++sample)
      {
        const unsigned int k  = 8;
        PricedQp           qp = random_qp(generator, 3 * k, sample % 2 == 0 ? 3 * k : 5);
        qp.H.diagadd(1e-6);
        qp.limits.kinks.clear();
        Numbers start;
        for (unsigned int group = 0; group < 3; ++group)
        {
          const Numbers w = random_weights(generator, k, group),
                        v = random_weights(generator, k, 1);
          qp.limits.kinks.insert(qp.limits.kinks.end(), w.begin(), w.end());
          start.insert(start.end(), v.begin(), v.end());
        }
        const WeightQpSolution cold = minimize_over_weights(qp.H, qp.c, sums, qp.limits);
        expect_minimum(qp, cold, sums);
        for (const Numbers &from : { start, cold.weights })
        {
          const WeightQpSolution warm = minimize_over_weights(qp.H, qp.c, sums, qp.limits, from);
          expect_minimum(qp, warm, sums);
          for (unsigned int i = 0; i < 3 * k; ++i)
            EXPECT_NEAR(warm.weights[i], cold.weights[i], 1e-6);
        }
      }
    }

    TEST(WeightQpKinks, NoPriceIsNoKinkAndAHugeOneHoldsAll)
    {
      std::mt19937 generator(5);
      for (int sample = 0; sample < 100; ++sample)
      {
        const unsigned int k  = 2 + sample % 4;
        PricedQp           qp = random_qp(generator, k, k);
        qp.H.diagadd(1e-3);
        const auto without = minimize_over_weights(qp.H, qp.c, { 1. }, Numbers(k, 0.));
        for (double &yield : qp.limits.yields)
          yield = 0.;
        const auto free = minimize_over_weights(qp.H, qp.c, { 1. }, qp.limits);
        for (unsigned int i = 0; i < k; ++i)
          EXPECT_NEAR(free.weights[i], without.weights[i], 1e-10);
        for (double &yield : qp.limits.yields)
          yield = 1e30;
        EXPECT_EQ(minimize_over_weights(qp.H, qp.c, { 1. }, qp.limits).weights, qp.limits.kinks);
        // changes of weights that are there: none, to the bit
        WeightLimits of_changes = qp.limits;
        for (unsigned int i = 0; i < k; ++i)
        {
          of_changes.lower[i] = -qp.limits.kinks[i];
          of_changes.kinks[i] = 0.;
        }
        EXPECT_EQ(minimize_over_weights(qp.H, qp.c, { 0. }, of_changes).weights, Numbers(k, 0.));
      }
    }
  } // namespace
} // namespace Exemplar::Testing
