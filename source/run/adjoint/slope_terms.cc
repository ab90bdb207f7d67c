// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/fibre_tension_term.h>
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
  add_at_vertices(const FESpace         &fe_space,
                  const unsigned int     cell,
                  const Matrix3<double> &by_gradient,
                  Vector                &to)
  {
    const auto      nodes = fe_space.nodes(cell);
    const Vector   &X     = fe_space.rest_positions();
    Matrix3<double> edges; // columns from vertex 0
    for (int i = 0; i < 3; ++i)
      for (int v = 0; v < 3; ++v)
        edges[i][v] = X[3 * nodes[v + 1] + i] - X[3 * nodes[0] + i];
    const Matrix3<double> cofactor = cofactors(edges); // columns over the determinant: grad L_v
    const Matrix3<double> forces
        = combine(1. / determinant(edges), by_gradient * cofactor, 0., cofactor);
    for (unsigned int c = 0; c < 3; ++c)
      for (unsigned int v = 0; v < 3; ++v)
      {
        to[3 * nodes[v + 1] + c] += forces[c][v];
        to[3 * nodes[0] + c] -= forces[c][v];
      }
  }

  void
  add_slope_of_ridge(const Problem &problem, const Direction &direction, SlopeDerivatives &sums)
  {
    if (problem.examples.weights.n_unknown() == 0)
      return;
    const FESpace                    &fe_space   = problem.body.fe_space;
    const Material                   &material   = problem.body.material;
    const ExamplePoses               &poses      = problem.examples.poses;
    const ExampleParameters          &parameters = problem.parameters.examples;
    const double                      total      = fe_space.total_volume();
    const double                      by_unit    = parameters.ridge(1.) - parameters.ridge(0.);
    const std::vector<double>        &fractions  = poses.fractions();
    const std::vector<double>        &w = problem.state.weights, &b = direction.weights;
    const WeightMemory               &memory      = problem.examples.weights.get_memory();
    const dealii::FullMatrix<double> &preferences = problem.examples.weights.preferences();
    const double unit = unit_energy_of_examples(fe_space, material), sigma = parameters.ridge(unit);
    std::vector<double> products(fractions.size(), 0.); // w.b of each region, by parts of the ridge
    std::vector<double> preferred(fractions.size(), 0.); // likewise by preferences
    std::vector<double> prices(fractions.size(), 0.);    // of moving along b, per volume
    double              mean = 0., mean_preferred = 0.;
    for (unsigned int v = 0; v < preferences.m(); ++v)
      for (unsigned int weight = 0; weight < preferences.n(); ++weight)
      {
        const unsigned int region = v / poses.size();
        sums.by_weights[v] += unit * fractions[region] * preferences(v, weight) * b[weight];
        preferred[region] += w[v] * preferences(v, weight) * b[weight];
        mean_preferred += fractions[region] * w[v] * preferences(v, weight) * b[weight];
      }
    for (unsigned int weight = 0; weight < poses.n_weights(); ++weight)
    {
      const unsigned int region   = weight / poses.size();
      const double       of_ridge = problem.examples.weights.part_of_ridge(weight) * b[weight];
      sums.by_weights[weight] += sigma * fractions[region] * of_ridge;
      products[region] += w[weight] * of_ridge;
      mean += fractions[region] * w[weight] * of_ridge;
      if (memory.yields())
        prices[region]
            += memory.slopes(weight, w[weight], 0.).up * b[weight] / (fractions[region] * total);
    }
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      const unsigned int cell   = fe_space.cell_of(point);
      const double       volume = fe_space.volume(point);
      double             here = 0., here_preferred = 0., price = 0.;
      poses.get_strains().get_shares().for_each(point,
                                                [&](const unsigned int region, const double share)
                                                {
                                                  here += share * products[region];
                                                  here_preferred += share * preferred[region];
                                                  price += share * prices[region];
                                                });
      if (!material.elasticity_of_examples().youngs_modulus)
        sums.by_young[cell] += volume * (by_unit * mean + mean_preferred);
      sums.add_by_volume(
          cell, volume
                    * ((by_unit * mean + mean_preferred) * material.youngs_modulus_of_examples(cell)
                       + (sigma * (here - mean) + unit * (here_preferred - mean_preferred)) / total
                       + price));
    }
  }

  void
  add_slope_of_loads(const Problem &problem, const Direction &direction, SlopeDerivatives &sums)
  {
    const FESpace         &fe_space = problem.body.fe_space;
    const LoadsParameters &loads    = problem.parameters.loads;
    const double           ramp     = loads.ramp == LoadRamp::increments ? problem.state.time : 1.;
    sums.by_nodal_forces.add(-ramp, direction.positions);
    const bool is_consistent = problem.parameters.material.mass_matrix == MassMatrix::consistent;
    const NodeShares &shares
        = traits_of(fe_space.element())
              .in_cell.by(is_consistent ? ShareRule::consistent : ShareRule::lumped);
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      const double volume = fe_space.cell_volume(cell);
      const double mass   = volume * problem.body.material.density(cell);
      const auto   nodes  = fe_space.nodes(cell);
      double       work   = 0.; // of gravity on a unit mass, along the direction
      for (unsigned int a = 0; a < nodes.size(); ++a)
        for (unsigned int c = 0; c < 3; ++c)
        {
          const double part = -ramp
                              * (fe_space.is_shell() ? 1. / 3.
                                 : a < 4             ? shares.of_vertex(1.)
                                                     : shares.of_edge(1.))
                              * direction.positions[3 * nodes[a] + c];
          sums.by_gravity[c] += mass * part;
          work += part * loads.gravity[c];
        }
      sums.by_density[cell] += volume * work;
      sums.add_by_volume(cell, mass * work);
    }
  }

  void
  add_slope_of_tension(const Problem &problem, const Direction &direction, SlopeDerivatives &sums)
  {
    const FibreTensionTerm *term = find_tension_term(problem.potential.get_terms());
    if (term == nullptr)
      return;
    const FESpace &fe_space = problem.body.fe_space;
    const Vector  &x        = problem.state.positions;
    sums.by_tension.assign(fe_space.n_cells(), 0.);
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      const auto fibre = term->fibre(point, x);
      if (!fibre)
        continue;
      const unsigned int    cell   = fe_space.cell_of(point);
      const double          volume = fe_space.volume(point), tension = term->tensions()[cell];
      const Matrix3<double> F      = fe_space.deformation_gradient(point, x),
                            dF     = fe_space.deformation_gradient(point, direction.positions);
      const Vector3<double> change = dF * fibre->rest,
                            force  = fibre->change(change, Tangent::exact);
      const double    slope        = fibre->force_factor * dot(fibre->now, change);
      Matrix3<double> by_F, by_dF;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
        {
          by_F[i][j]  = volume * tension * force[i] * fibre->rest[j];
          by_dF[i][j] = volume * tension * fibre->force_factor * fibre->now[i] * fibre->rest[j];
        }
      add_forces(fe_space, point, by_F, sums.by_positions);
      sums.by_tension[cell] += volume * slope;
      sums.add_by_volume(cell, volume * tension * slope);
      sums.add_by_shape_gradients(
          cell, combine(1., transpose_times(F, by_F), 1., transpose_times(dF, by_dF)));
    }
  }
} // namespace Exemplar
