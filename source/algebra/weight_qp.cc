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
    /// Two weights nearer to each other than this differ by rounding alone.
    constexpr double rounding = 1e-14;

    class ActiveSet
    {
    public:
      ActiveSet(const dealii::FullMatrix<double> &H,
                const std::vector<double>        &c,
                const std::vector<double>        &sums,
                const WeightLimits               &limits,
                const std::vector<double>        &start)
          : H(H), c(c), lower(limits.lower), limits(limits), group_size(c.size() / sums.size()),
            weights(start.empty() ? lower : start), at_bound(c.size(), !lower.empty()),
            side(c.size(), 0)
      {
        if (!limits.kinks.empty())
        {
          begin_among_kinks(sums, start);
          return;
        }
        weights.resize(c.size());
        for (unsigned int group = 0; group < sums.size(); ++group)
        {
          const auto begin = weights.begin() + first_of(group), end = begin + group_size;
          if (lower.empty()) // without bounds: any point with the right sum
            std::fill(begin, end, sums[group] / static_cast<double>(group_size));
          else
          {
            // on the simplex: the start, or a corner
            const auto   first = c.begin() + first_of(group);
            const auto   best  = start.empty()
                                     ? std::max_element(first, first + group_size) - c.begin()
                                     : farthest_from_bound(group);
            const double rest  = sums[group] - std::accumulate(begin, end, 0.);
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
            solution.multipliers.push_back(multiplier(g, group));
          if (!release(g, solution.multipliers))
          {
            solution.found   = true;
            solution.weights = weights;
            return solution;
          }
        }
        return solution;
      }

    private:
      /// Initial guess and active set from the start, or from the kinks.
      void
      begin_among_kinks(const std::vector<double> &sums, const std::vector<double> &start)
      {
        weights = start.empty() ? limits.kinks : start;
        for (std::size_t i = 0; i < c.size(); ++i)
        {
          at_bound[i] = !(weights[i] > lower[i]);
          side[i]     = side_of(i);
        }
        for (unsigned int group = 0; group < sums.size(); ++group)
        {
          const auto   begin = weights.begin() + first_of(group);
          const double rest  = sums[group] - std::accumulate(begin, begin + group_size, 0.);
          const auto   best  = farthest_from_bound(group);
          if (!is_fixed(best))
            weights[best] += rest;
        }
      }

      /// Position of a weight: above (1) or below (-1) its kink, or stuck there (0). A weight at
      /// its bound and its kink can only increase.
      int
      side_of(const std::size_t i) const
      {
        const double kink = limits.kinks[i];
        if (at_bound[i])
          return kink > lower[i] ? -1 : 1;
        return weights[i] == kink ? 0 : weights[i] > kink ? 1 : -1;
      }

      bool
      has_kinks() const
      {
        return !limits.kinks.empty();
      }

      bool
      is_fixed(const std::size_t i) const
      {
        return at_bound[i] || is_stuck(i);
      }

      bool
      is_stuck(const std::size_t i) const
      {
        return has_kinks() && side[i] == 0;
      }

      std::size_t
      first_of(const unsigned int group) const
      {
        return group * group_size;
      }

      std::size_t
      farthest_from_bound(const unsigned int group) const
      {
        std::size_t farthest = first_of(group);
        for (std::size_t i = first_of(group); i < first_of(group + 1); ++i)
          if (is_stuck(farthest)
              || (!is_stuck(i) && weights[i] - lower[i] > weights[farthest] - lower[farthest]))
            farthest = i;
        return farthest;
      }

      /// The gradient, including the yields of weights off their kinks.
      std::vector<double>
      gradient() const
      {
        std::vector<double> g(c.size());
        for (unsigned int i = 0; i < c.size(); ++i)
        {
          g[i] = -c[i];
          for (unsigned int j = 0; j < c.size(); ++j)
            g[i] += H(i, j) * weights[j];
          if (has_kinks())
            g[i] += side[i] * limits.yields[i];
        }
        return g;
      }

      /// The multiplier of a group whose weights are all fixed: the middle of the interval that
      /// their conditions allow (its lower end, if it has no upper one) or, if they contradict each
      /// other, of the gap.
      double
      multiplier_of_fixed(const std::vector<double> &g, const unsigned int group) const
      {
        double least    = -std::numeric_limits<double>::infinity();
        double greatest = -least;
        for (std::size_t i = first_of(group); i < first_of(group + 1); ++i)
        {
          const double yield = is_stuck(i) ? limits.yields[i] : 0.;
          least              = std::max(least, -g[i] - yield);
          if (is_stuck(i))
            greatest = std::min(greatest, -g[i] + yield);
        }
        return std::isfinite(greatest) ? 0.5 * (least + greatest) : least;
      }

      /// The multiplier of a group: minus the mean derivative by its free weights.
      double
      multiplier(const std::vector<double> &g, const unsigned int group) const
      {
        double       total = 0.;
        unsigned int n     = 0;
        for (std::size_t i = first_of(group); i < first_of(group + 1); ++i)
          if (!is_fixed(i))
          {
            total += g[i];
            ++n;
          }
        return n == 0 ? multiplier_of_fixed(g, group) : -(total / n);
      }

      /// The step to the minimiser over the free weights, in coordinates e_i - e_r with the last
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
          while (r > first_of(group) && is_fixed(r)) // at least one is free without kinks
                                                     // always free
            --r;
          for (std::size_t i = first_of(group); i < r; ++i)
            if (!is_fixed(i))
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

      /// Take the step as far as bounds and kinks allow; returns whether the whole step was.
      bool
      take(const std::vector<double> &step)
      {
        double       length  = 1.;
        unsigned int meeting = c.size();
        for (unsigned int i = 0; i < c.size() && !lower.empty(); ++i)
          if (const double *const end = end_of_way(i, step))
            if (const double until = (*end - weights[i]) / step[i]; until < length)
            {
              length  = has_kinks() ? std::max(until, 0.) : until;
              meeting = i;
            }
        for (unsigned int i = 0; i < c.size(); ++i)
          weights[i] += length * step[i];
        if (meeting == c.size())
          return true;
        stop(meeting, step);
        // stop all weights that arrive, too: one that is off its kink by rounding seems to be
        // pulled
        for (unsigned int i = 0; i < c.size() && has_kinks(); ++i)
          if (const double *const end = end_of_way(i, step);
              end != nullptr && std::abs(weights[i] - *end) <= rounding)
            stop(i, step);
        return false;
      }

      /// The bound or kink that a free weight meets in the direction of a step, or null.
      const double *
      end_of_way(const unsigned int i, const std::vector<double> &step) const
      {
        if (is_fixed(i))
          return nullptr;
        const bool meets_kink = has_kinks() && side[i] * step[i] < 0. && limits.kinks[i] > lower[i];
        if (meets_kink)
          return &limits.kinks[i];
        return step[i] < 0. ? &lower[i] : nullptr;
      }

      /// Fix a weight at the bound or kink that it meets.
      void
      stop(const unsigned int i, const std::vector<double> &step)
      {
        const double *const end = end_of_way(i, step);
        weights[i]              = *end;
        at_bound[i]             = end == &lower[i];
        if (has_kinks())
          side[i] = side_of(i);
      }

      /// Free the weight that violates its condition most; returns whether there was one.
      bool
      release(const std::vector<double> &g, const std::vector<double> &multipliers)
      {
        double       worst    = -1e-13 * max_entry(g);
        unsigned int released = c.size();
        int          to       = 0;
        const auto   compare  = [&](const unsigned int i, const double slope, const int new_side)
        {
          if (!(slope < worst))
            return;
          worst    = slope;
          released = i;
          to       = new_side;
        };
        for (unsigned int i = 0; i < c.size(); ++i)
        {
          const double excess = g[i] + multipliers[i / group_size];
          if (at_bound[i])
            compare(i, excess, side[i]);
          else if (is_stuck(i))
          {
            compare(i, excess + limits.yields[i], 1);
            compare(i, -excess + limits.yields[i], -1);
          }
        }
        if (released == c.size())
          return false;
        at_bound[released] = false;
        side[released]     = to;
        return true;
      }

      const dealii::FullMatrix<double> &H;
      const std::vector<double>        &c;
      const std::vector<double>        &lower;
      const WeightLimits               &limits;
      const std::size_t                 group_size;
      std::vector<double>               weights;
      std::vector<bool>                 at_bound;
      std::vector<int>                  side; ///< side_of() each weight; 0 without kinks
    };

    /// A program with bounds from above as one with sums: weight i, 2 i here, and what it lacks to
    /// its bound, 2 i + 1, are a group, between whom its kink is shared.
    class PairedProgram
    {
    public:
      PairedProgram(const dealii::FullMatrix<double> &form,
                    const std::vector<double>        &linear,
                    const WeightLimits               &limits,
                    const std::vector<double>        &start)
          : H(2 * linear.size(), 2 * linear.size()), sums(limits.upper),
            start(pairs(start, limits.upper))
      {
        for (std::size_t i = 0; i < linear.size(); ++i)
        {
          for (std::size_t j = 0; j < linear.size(); ++j)
            H(2 * i, 2 * j) = form(i, j);
          c.insert(c.end(), { linear[i], 0. });
          of_pairs.lower.insert(of_pairs.lower.end(), { limits.lower[i], 0. });
        }
        of_pairs.kinks = pairs(limits.kinks, limits.upper);
        for (const double yield : limits.yields)
          of_pairs.yields.insert(of_pairs.yields.end(), 2, 0.5 * yield);
      }

      WeightQpSolution
      solve() const
      {
        const WeightQpSolution of_all = ActiveSet(H, c, sums, of_pairs, start).solve();
        WeightQpSolution       solution;
        solution.found = of_all.found;
        for (std::size_t i = 0; i < of_all.weights.size(); i += 2)
          solution.weights.push_back(of_all.weights[i + 1] == 0. ? sums[i / 2] // without rounding
                                                                 : of_all.weights[i]);
        return solution;
      }

    private:
      /// Weights, if any, with what they lack.
      static std::vector<double>
      pairs(const std::vector<double> &weights, const std::vector<double> &upper)
      {
        std::vector<double> all;
        for (std::size_t i = 0; i < weights.size(); ++i)
          all.insert(all.end(), { weights[i], upper[i] - weights[i] });
        return all;
      }

      dealii::FullMatrix<double> H;
      std::vector<double>        c;
      const std::vector<double> &sums;
      WeightLimits               of_pairs;
      const std::vector<double>  start;
    };
  } // namespace

  WeightQpSolution
  minimize_over_weights(const dealii::FullMatrix<double> &H,
                        const std::vector<double>        &c,
                        const std::vector<double>        &sums,
                        const WeightLimits               &limits,
                        const std::vector<double>        &start)
  {
    if (c.empty())
      return { true, {}, {} };
    if (!limits.upper.empty())
      return PairedProgram(H, c, limits, start).solve();
    return ActiveSet(H, c, sums, limits, start).solve();
  }

  WeightQpSolution
  minimize_over_weights(const WeightForm                 &form,
                        const dealii::FullMatrix<double> &schur,
                        const std::vector<double>        &c,
                        const std::vector<double>        &sums,
                        const WeightLimits               &limits,
                        const std::vector<double>        &start)
  {
    WeightQpSolution solution = minimize_over_weights(schur, c, sums, limits, start);
    if (solution.found || form.convexity.empty())
      return solution;
    dealii::FullMatrix<double> convex = schur;
    for (std::size_t i = 0; i < form.convexity.size(); ++i)
      convex(i, i) += form.convexity[i];
    return minimize_over_weights(convex, c, sums, limits, start);
  }
} // namespace Exemplar
