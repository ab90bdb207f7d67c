// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/weight_qp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace Exemplar
{
  namespace
  {
    /// Solve A x = b in place by Cholesky; false if A is not positive definite.
    bool
    solve_by_cholesky(dealii::FullMatrix<double> &A, std::vector<double> &b)
    {
      const unsigned int n = b.size();
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j <= i; ++j)
        {
          const double before = A(i, j);
          double       value  = before;
          for (unsigned int m = 0; m < j; ++m)
            value -= A(i, m) * A(j, m);
          if (i != j)
            A(i, j) = value / A(j, j);
          else if (value > 1e-14 * std::abs(before) && value > 0.)
            A(i, i) = std::sqrt(value);
          else
            return false;
        }
      for (unsigned int i = 0; i < n; ++i)
      {
        for (unsigned int m = 0; m < i; ++m)
          b[i] -= A(i, m) * b[m];
        b[i] /= A(i, i);
      }
      for (unsigned int i = n; i-- > 0;)
      {
        for (unsigned int m = i + 1; m < n; ++m)
          b[i] -= A(m, i) * b[m];
        b[i] /= A(i, i);
      }
      return true;
    }

    class ActiveSet
    {
    public:
      ActiveSet(const dealii::FullMatrix<double> &H,
                const std::vector<double>        &c,
                const double                      sum,
                const std::vector<double>        &lower)
          : H(H), c(c), lower(lower), weights(lower), at_bound(c.size(), !lower.empty())
      {
        // a corner of the simplex, or, unbounded, any point on the plane
        if (lower.empty())
          weights.assign(c.size(), sum / static_cast<double>(c.size()));
        else
        {
          const auto first
              = static_cast<std::size_t>(std::max_element(c.begin(), c.end()) - c.begin());
          weights[first] += sum - std::accumulate(lower.begin(), lower.end(), 0.);
          at_bound[first] = false;
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
          solution.multiplier         = -mean_of_free(g);
          if (!release_a_bound(g, solution.multiplier))
          {
            solution.found   = true;
            solution.weights = weights;
            return solution;
          }
        }
        return solution;
      }

    private:
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
      mean_of_free(const std::vector<double> &g) const
      {
        double       total = 0.;
        unsigned int n     = 0;
        for (unsigned int i = 0; i < g.size(); ++i)
          if (!at_bound[i])
          {
            total += g[i];
            ++n;
          }
        return total / n;
      }

      /// To the minimiser over the free weights, in coordinates e_i - e_r of the plane.
      bool
      find_step(std::vector<double> &step) const
      {
        std::vector<unsigned int> free;
        for (unsigned int i = 0; i < c.size(); ++i)
          if (!at_bound[i])
            free.push_back(i);
        const unsigned int         r = free.back(), n = free.size() - 1;
        const std::vector<double>  g = gradient();
        dealii::FullMatrix<double> A(n, n);
        std::vector<double>        x(n);
        for (unsigned int i = 0; i < n; ++i)
        {
          x[i] = g[r] - g[free[i]];
          for (unsigned int j = 0; j < n; ++j)
            A(i, j) = H(free[i], free[j]) - H(free[i], r) - H(r, free[j]) + H(r, r);
        }
        if (!solve_by_cholesky(A, x))
          return false;
        step.assign(c.size(), 0.);
        for (unsigned int i = 0; i < n; ++i)
        {
          step[free[i]] = x[i];
          step[r] -= x[i];
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
      release_a_bound(const std::vector<double> &g, const double multiplier)
      {
        double scale = std::abs(multiplier);
        for (const double entry : g)
          scale = std::max(scale, std::abs(entry));
        double       worst   = -1e-13 * scale;
        unsigned int release = c.size();
        for (unsigned int i = 0; i < c.size(); ++i)
          if (at_bound[i] && g[i] + multiplier < worst)
          {
            worst   = g[i] + multiplier;
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
      std::vector<double>               weights;
      std::vector<bool>                 at_bound;
    };
  } // namespace

  WeightQpSolution
  minimize_over_weights(const dealii::FullMatrix<double> &H,
                        const std::vector<double>        &c,
                        const double                      sum,
                        const std::vector<double>        &lower)
  {
    return ActiveSet(H, c, sum, lower).solve();
  }
} // namespace Exemplar
