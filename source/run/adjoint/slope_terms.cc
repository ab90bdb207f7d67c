// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/adjoint/slope_terms.h>

namespace Exemplar
{
  void
  add_forces(const FESpace         &fe_space,
             const unsigned int     point,
             const Matrix3<double> &by_F,
             Vector                &to)
  {
    const auto nodes = fe_space.nodes(fe_space.cell_of(point));
    const auto g     = fe_space.gradients(point);
    for (unsigned int a = 0; a < nodes.size(); ++a)
    {
      const Vector3<double> force = by_F * g[a];
      for (int c = 0; c < 3; ++c)
        to[3 * nodes[a] + c] += force[c];
    }
  }

  void
  add_volume(const FESpace &fe_space, const unsigned int point, const double by_volume, Vector &to)
  {
    add_forces(fe_space, point,
               combine(by_volume, identity_matrix<double>(), 0., Matrix3<double>{}), to);
  }

  void
  add_slope_of_ridge(const Problem &problem, const Direction &direction, SlopeDerivatives &sums)
  {
    if (problem.examples.weights.n_unknown() == 0)
      return;
    const FESpace             &fe_space   = problem.body.fe_space;
    const Material            &material   = problem.body.material;
    const ExamplePoses        &poses      = problem.examples.poses;
    const ExampleParameters   &parameters = problem.parameters.examples;
    const double               total      = fe_space.total_volume();
    const double               sigma      = parameters.ridge(unit_energy(fe_space, material));
    const double               by_unit    = parameters.ridge(1.) - parameters.ridge(0.);
    const std::vector<double>  fractions  = poses.volume_fractions();
    const std::vector<double> &w = problem.state.weights, &b = direction.weights;
    std::vector<double>        products(fractions.size(), 0.); // w.b of each region
    double                     mean = 0.;
    for (unsigned int weight = 0; weight < poses.n_weights(); ++weight)
    {
      const unsigned int region = weight / poses.size();
      sums.by_weights[weight] += sigma * fractions[region] * b[weight];
      products[region] += w[weight] * b[weight];
      mean += fractions[region] * w[weight] * b[weight];
    }
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      const double volume = fe_space.volume(point);
      double       here   = 0.;
      poses.get_regions().for_each(point, [&](const unsigned int region, const double share)
                                   { here += share * products[region]; });
      sums.by_young[point] += by_unit * volume * mean;
      add_volume(
          fe_space, point,
          volume
              * (by_unit * material.youngs_modulus(point) * mean + sigma * (here - mean) / total),
          sums.by_rest_positions);
    }
  }

  void
  add_slope_of_loads(const Problem &problem, const Direction &direction, SlopeDerivatives &sums)
  {
    const FESpace         &fe_space = problem.body.fe_space;
    const LoadsParameters &loads    = problem.parameters.loads;
    const double           ramp     = loads.ramp == LoadRamp::increments ? problem.state.time : 1.;
    sums.by_nodal_forces.add(-ramp, direction.positions);
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      const double mass = fe_space.volume(point) * problem.body.material.density(point);
      double       work = 0.; // of gravity on a unit of mass, along the direction
      for (const unsigned int node : fe_space.nodes(point))
        for (unsigned int c = 0; c < 3; ++c)
        {
          const double mean = -0.25 * ramp * direction.positions[3 * node + c];
          sums.by_gravity[c] += mass * mean;
          work += mean * loads.gravity[c];
        }
      sums.by_density[point] += fe_space.volume(point) * work;
      add_volume(fe_space, point, mass * work, sums.by_rest_positions);
    }
  }
} // namespace Exemplar
