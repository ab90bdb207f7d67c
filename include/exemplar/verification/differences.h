// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_differences_h
#define exemplar_differences_h

#include <exemplar/algebra/long_vectors.h>
#include <exemplar/run/problem.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace Exemplar::Verification
{
  /// Whether rotations follow the positions, or are kept so that the energy is quadratic.
  enum class Rotations
  {
    followed,
    kept
  };

  /// Derivatives of the cells' energy at a state: errors of the program's relative to finite
  /// differences.
  class Differences
  {
  public:
    /// `weights` [-] are used if the problem has examples.
    Differences(Problem                      &problem,
                const dealii::Vector<double> &positions,
                const std::vector<double>    &weights,
                Rotations                     rotations)
        : problem(problem), x(positions),
          w(problem.examples.poses.size() > 0 ? weights : std::vector<double>()),
          rotations(rotations)
    {
      problem.cells.get_field().update_rotations(x);
      at = evaluate(x, w);
      problem.cells.get_field().update_rotations(x);
      matrix.resize(problem.potential.get_tangent().get_pattern().n_values());
      problem.cells.assemble_tangent(rotations == Rotations::followed ? Tangent::exact
                                                                      : Tangent::convex,
                                     x, w, matrix, columns);
    }

    /// Greatest error of the gradient, relative to 1 + its greatest entry.
    double
    of_gradient() const
    {
      double maximum = 0.;
      for (unsigned int dof = 0; dof < x.size(); ++dof)
      {
        const double slope
            = derivative([&](const double h) { return shifted(unit(dof), h).energy; });
        maximum = max_or_nan(maximum, std::abs(slope - at.gradient[dof]));
      }
      return maximum / (1. + max_entry(at.gradient.begin(), at.gradient.end()));
    }

    /// Relative error of the slope of the energy along its gradient f, which is |f|.
    double
    along_gradient() const
    {
      const double norm = at.gradient.l2_norm();
      if (norm < 1e-12)
        return norm; // no such direction at rest
      dealii::Vector<double> direction = at.gradient;
      direction /= norm;
      const double slope = derivative([&](const double h) { return shifted(direction, h).energy; });
      return std::abs(slope - norm) / (1. + norm);
    }

    /// Greatest error of the entries of the tangent, relative to the greatest entry.
    double
    of_tangent() const
    {
      const auto &free    = problem.constraints.free_dofs.list();
      double      maximum = 0., scale = 1.;
      for (unsigned int j = 0; j < free.size(); ++j)
      {
        const auto column = derivative_of_gradient(unit(free[j]));
        for (unsigned int i = 0; i < free.size(); ++i)
        {
          maximum = max_or_nan(maximum, std::abs(column[free[i]] - entry(i, j)));
          scale   = max_or_nan(scale, std::abs(entry(i, j)));
        }
      }
      return maximum / scale;
    }

    /// Greatest error of the derivatives by the weights and of the coupling -G, relative to 1 + the
    /// greatest entry of the gradient.
    double
    of_weights() const
    {
      const auto &free    = problem.constraints.free_dofs.list();
      double      maximum = 0.;
      for (unsigned int k = 0; k < w.size(); ++k)
      {
        const auto weight_moved = [&](const double h)
        {
          std::vector<double> moved = w;
          moved[k] += h;
          return evaluate(x, moved);
        };
        const double slope = derivative([&](const double h) { return weight_moved(h).energy; });
        maximum            = max_or_nan(maximum, std::abs(slope - at.weight_gradient[k]));
        for (unsigned int i = 0; i < free.size(); ++i)
        {
          const double change
              = derivative([&](const double h) { return weight_moved(h).gradient[free[i]]; });
          const double entry
              = problem.examples.poses.is_strained(k)
                    ? columns[problem.examples.poses.strained_index(k) * free.size() + i]
                    : 0.;
          maximum = max_or_nan(maximum, std::abs(change + entry));
        }
      }
      return maximum / (1. + max_entry(at.gradient.begin(), at.gradient.end()));
    }

  private:
    /// Central difference of fourth order at 0.
    template <typename Function>
    static double
    derivative(const Function &f)
    {
      const double h = 1e-3;
      return (8. * (f(h) - f(-h)) - (f(2. * h) - f(-2. * h))) / (12. * h);
    }

    dealii::Vector<double>
    derivative_of_gradient(const dealii::Vector<double> &direction) const
    {
      const double           h = 1e-3;
      dealii::Vector<double> sum(x.size());
      for (const auto &[steps, factor] :
           { std::pair(1., 8.), std::pair(-1., -8.), std::pair(2., -1.), std::pair(-2., 1.) })
        sum.add(factor / (12. * h), shifted(direction, steps * h).gradient);
      return sum;
    }

    dealii::Vector<double>
    unit(const unsigned int dof) const
    {
      dealii::Vector<double> direction(x.size());
      direction[dof] = 1.;
      return direction;
    }

    ElasticEvaluation
    shifted(const dealii::Vector<double> &direction, const double h) const
    {
      dealii::Vector<double> moved = x;
      moved.add(h, direction);
      return evaluate(moved, w);
    }

    ElasticEvaluation
    evaluate(const dealii::Vector<double> &positions, const std::vector<double> &at_weights) const
    {
      if (rotations == Rotations::followed)
        problem.cells.get_field().update_rotations(positions);
      ElasticEvaluation evaluation;
      problem.cells.evaluate(positions, at_weights, evaluation);
      return evaluation;
    }

    double
    entry(unsigned int i, unsigned int j) const
    {
      if (i < j)
        std::swap(i, j);
      const auto &pattern  = problem.potential.get_tangent().get_pattern();
      const int   position = pattern.position(i, j);
      const bool  is_there
          = position < pattern.column_start[j + 1] && pattern.row[position] == static_cast<int>(i);
      return is_there ? matrix[position] : 0.;
    }

    Problem                     &problem;
    const dealii::Vector<double> x;
    const std::vector<double>    w;
    const Rotations              rotations;
    ElasticEvaluation            at;
    std::vector<double>          matrix;
    std::vector<double>          columns;
  };
} // namespace Exemplar::Verification

#endif
