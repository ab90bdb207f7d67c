// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/extent.h>
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/solvers/saddle.h>

#include <algorithm>
#include <random>

namespace Exemplar
{
  namespace
  {
    constexpr unsigned int max_power_iterations = 60;

    /// Above the ratios v.K v / v.A v of convex parts: K has at most 8/7 of a mixture with an
    /// eighth of the convex tangent.
    constexpr double shift = 1.2;

    Vector
    arbitrary_displacement(const IncrementalPotential &potential, const unsigned int n)
    {
      Vector       displacement(n);
      std::mt19937 generator(1); // gives the same numbers everywhere
      for (const unsigned int dof : potential.get_free_dofs().list())
        displacement[dof] = static_cast<double>(generator()) / 4294967296. - 0.5;
      potential.get_free_dofs().exchange().share(displacement);
      return displacement;
    }

    /// K v, by central differences; only what belongs to free degrees of freedom means anything.
    Vector
    times_tangent(IncrementalPotential &potential, const State &at, const Vector &displacement)
    {
      Evaluation   evaluation;
      const double length = 1e-6 * extent(at.positions, potential.get_free_dofs().exchange());
      Vector       change;
      for (const double side : { length, -length })
      {
        State beside = at;
        beside.positions.add(side, displacement);
        potential.minimize_over_weights(beside, RotationUse::update, evaluation);
        if (change.size() == 0)
          change = evaluation.gradient;
        else
          change -= evaluation.gradient;
      }
      change /= 2. * length;
      return change;
    }

    double
    free_product(const IncrementalPotential &potential, const Vector &a, const Vector &b)
    {
      double sum = 0.;
      for (const unsigned int dof : potential.get_free_dofs().list())
        sum += a[dof] * b[dof];
      return potential.get_free_dofs().exchange().sum(sum);
    }
  } // namespace

  Vector
  downward_curvature(StepSystem &system, IncrementalPotential &potential, const State &at)
  {
    const std::vector<double> none(potential.get_weights().n_unknown());
    Vector                    v = arbitrary_displacement(potential, at.positions.size());
    for (unsigned int i = 0; i < max_power_iterations; ++i)
    {
      const Vector Kv = times_tangent(potential, at, v);
      if (i > 0 && free_product(potential, v, Kv) < 0.)
        return v;
      v *= shift;
      v += system.displacement(at, system.solve(at, Kv, none)); // -A^-1 K v
      const double maximum
          = potential.get_free_dofs().exchange().max(max_entry(v.begin(), v.end()));
      if (!(maximum > 0.))
        break;
      v /= maximum;
    }
    return {};
  }
} // namespace Exemplar
