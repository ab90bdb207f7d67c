// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/dense.h>
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/algebra/weight_qp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace Exemplar
{
  namespace
  {
    class ActiveSet
    {
    public:
      ActiveSet(const dealii::FullMatrix<double> &H,
                const std::vector<double>        &c,
                const std::vector<double>        &sums,
                const std::vector<double>        &lower,
                const std::vector<double>        &start)
          : H(H), c(c), lower(lower), group_size(c.size() / sums.size()),
            weights(start.empty() ? lower : start), at_bound(c.size(), !lower.empty())
      {
        weights.resize(c.size());
        for (unsigned int group = 0; group < sums.size(); ++group)
        {
          const auto begin = weights.begin() + first_of(group), end = begin + group_size;
          if (lower.empty()) // any point on the plane
            std::fill(begin, end, sums[group] / static_cast<double>(group_size));
          else
          {
            // of the simplex the start, or a corner
            const auto   best = start.empty() ? best_of(group) : farthest_from_bound(group);
            const double rest = sums[group] - std::accumulate(begin, end, 0.);
            weights[best] += rest;
            for (std::size_t i = first_of(group); i < first_of(group + 1); ++i)
              at_bound[i] = i != best && !(weights[i] > lower[i]);
          }
        }
      }

      WeightQpSolution
      solve()
      {
        WeightQpSolution solution;
        for (unsigned int iteration = 0; iteration < 50 * (c.size() + 1); ++iteration)
        {
          std::vector<double> step;
          if (!find_step(step))
            return solution;
          if (!take(step))
            continue; // a bound was met
          const std::vector<double> g = gradient();
          solution.multipliers.clear();
          for (unsigned int group = 0; group < c.size() / group_size; ++group)
            solution.multipliers.push_back(-mean_of_free(g, group));
          if (!release_a_bound(g, solution.multipliers))
          {
            solution.found   = true;
            solution.weights = weights;
            return solution;
          }
        }
        return solution;
      }

    private:
      std::size_t
      first_of(const unsigned int group) const
      {
        return group * group_size;
      }

      std::size_t
      best_of(const unsigned int group) const
      {
        return std::max_element(c.begin() + first_of(group), c.begin() + first_of(group + 1))
               - c.begin();
      }

      std::size_t
      farthest_from_bound(const unsigned int group) const
      {
        std::size_t farthest = first_of(group);
        for (std::size_t i = first_of(group); i < first_of(group + 1); ++i)
          if (weights[i] - lower[i] > weights[farthest] - lower[farthest])
            farthest = i;
        return farthest;
      }

      std::vector<double>
      gradient() const
      {
        std::vector<double> g(c.size());
        for (unsigned int i = 0; i < c.size(); ++i)
        {
          g[i] = -c[i];
          for (unsigned int j = 0; j < c.size(); ++j)
            g[i] += H(i, j) * weights[j];
        }
        return g;
      }

      double
      mean_of_free(const std::vector<double> &g, const unsigned int group) const
      {
        double       total = 0.;
        unsigned int n     = 0;
        for (std::size_t i = first_of(group); i < first_of(group + 1); ++i)
          if (!at_bound[i])
          {
            total += g[i];
            ++n;
          }
        return total / n;
      }

      /// To the minimiser over the free weights, in coordinates e_i - e_r with the last
      /// free weight r of i's group.
      bool
      find_step(std::vector<double> &step) const
      {
        struct Coordinate
        {
          std::size_t i, r;
        };
        std::vector<Coordinate> coordinates;
        for (unsigned int group = 0; group < c.size() / group_size; ++group)
        {
          std::size_t r = first_of(group + 1) - 1;
          while (at_bound[r]) // one is always free
            --r;
          for (std::size_t i = first_of(group); i < r; ++i)
            if (!at_bound[i])
              coordinates.push_back({ i, r });
        }
        const std::size_t          n = coordinates.size();
        const std::vector<double>  g = gradient();
        dealii::FullMatrix<double> A(n, n);
        std::vector<double>        x(n);
        for (std::size_t m = 0; m < n; ++m)
        {
          const auto [i, r] = coordinates[m];
          x[m]              = g[r] - g[i];
          for (std::size_t o = 0; o < n; ++o)
          {
            const auto [j, s] = coordinates[o];
            A(m, o)           = H(i, j) - H(i, s) - H(r, j) + H(r, s);
          }
        }
        if (!solve_by_cholesky(A, x))
          return false;
        step.assign(c.size(), 0.);
        for (std::size_t m = 0; m < n; ++m)
        {
          step[coordinates[m].i] = x[m];
          step[coordinates[m].r] -= x[m];
        }
        return true;
      }

      /// As far as the bounds allow; whether the whole step was.
      bool
      take(const std::vector<double> &step)
      {
        double       length  = 1.;
        unsigned int meeting = c.size();
        for (unsigned int i = 0; i < c.size() && !lower.empty(); ++i)
          if (!at_bound[i] && step[i] < 0.)
            if (const double until = (lower[i] - weights[i]) / step[i]; until < length)
            {
              length  = until;
              meeting = i;
            }
        for (unsigned int i = 0; i < c.size(); ++i)
          weights[i] += length * step[i];
        if (meeting == c.size())
          return true;
        weights[meeting]  = lower[meeting];
        at_bound[meeting] = true;
        return false;
      }

      /// Let go the bound whose multiplier has the worst sign; whether there was one.
      bool
      release_a_bound(const std::vector<double> &g, const std::vector<double> &multipliers)
      {
        double       worst   = -1e-13 * max_entry(g);
        unsigned int release = c.size();
        for (unsigned int i = 0; i < c.size(); ++i)
          if (const double excess = g[i] + multipliers[i / group_size];
              at_bound[i] && excess < worst)
          {
            worst   = excess;
            release = i;
          }
        if (release == c.size())
          return false;
        at_bound[release] = false;
        return true;
      }

      const dealii::FullMatrix<double> &H;
      const std::vector<double>        &c;
      const std::vector<double>        &lower;
      const std::size_t                 group_size;
      std::vector<double>               weights;
      std::vector<bool>                 at_bound;
    };
  } // namespace

  WeightQpSolution
  minimize_over_weights(const dealii::FullMatrix<double> &H,
                        const std::vector<double>        &c,
                        const std::vector<double>        &sums,
                        const std::vector<double>        &lower,
                        const std::vector<double>        &start)
  {
    if (c.empty())
      return { true, {}, {} };
    return ActiveSet(H, c, sums, lower, start).solve();
  }
} // namespace Exemplar
