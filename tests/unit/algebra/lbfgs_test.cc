// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/lbfgs.h>
#include <exemplar/algebra/long_vectors.h>

#include <gtest/gtest.h>

#include <random>

namespace Exemplar::Testing
{
  namespace
  {
    TEST(LbfgsTest, TheCorrectionAsAWholeIsThatOfTheTwoLoops)
    {
      std::mt19937                     generator(3);
      std::normal_distribution<double> normal;
      const std::size_t                n      = 20;
      const auto                       random = [&]
      {
        std::vector<double> vector(n);
        for (double &entry : vector)
          entry = normal(generator);
        return vector;
      };
      const auto H0 = [](std::vector<double> &vector)
      {
        for (std::size_t i = 0; i < vector.size(); ++i)
          vector[i] *= 0.1 + 0.05 * static_cast<double>(i);
      };
      Lbfgs lbfgs(Exchange::serial());
      for (unsigned int n_pairs = 0; n_pairs <= Lbfgs::max_pairs + 2; ++n_pairs)
      {
        const std::vector<double> vector = random();
        std::vector<double>       loops  = vector;
        lbfgs.before(loops);
        H0(loops);
        lbfgs.after(loops);

        const LbfgsCorrection correction = lbfgs.correction(H0);
        std::vector<double>   whole      = vector;
        H0(whole);
        for (std::size_t i = 0; i < correction.columns.size(); ++i)
          for (std::size_t j = 0; j < correction.columns.size(); ++j)
            add(whole, correction.matrix(i, j) * dot(vector, *correction.columns[j]),
                *correction.columns[i]);
        for (std::size_t i = 0; i < n; ++i)
          EXPECT_NEAR(whole[i], loops[i], 1e-10) << n_pairs;

        std::vector<double> s = random(), y = s;
        for (std::size_t i = 0; i < n; ++i)
          y[i] = 3. * s[i] + 0.3 * normal(generator);
        lbfgs.add_pair(s, y);
      }
    }
  } // namespace
} // namespace Exemplar::Testing
