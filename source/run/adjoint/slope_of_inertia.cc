// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/adjoint/slope_of_motion.h>
#include <exemplar/run/adjoint/slope_terms.h>

#include <deal.II/lac/full_matrix.h>

namespace Exemplar
{
  namespace
  {
    /// Mass matrix of the nodes of a cell with a mass of 1 (scalar).
    dealii::FullMatrix<double>
    unit_matrix(const FESpace &fe_space, const MassMatrix kind)
    {
      dealii::FullMatrix<double> m = fe_space.unit_mass_matrix();
      if (kind == MassMatrix::consistent)
        return m;
      const NodeShares &shares = traits_of(fe_space.element()).in_cell.by(ShareRule::lumped);
      m                        = 0.;
      for (unsigned int a = 0; a < m.m(); ++a)
        m(a, a) = a < 4 ? shares.of_vertex(1.) : shares.of_edge(1.);
      return m;
    }

    /// sum_ij m_ij a_i.q_j over the nodes of a cell.
    double
    product(const dealii::ArrayView<const unsigned int> &nodes,
            const dealii::FullMatrix<double>            &m,
            const Vector                                &a,
            const Vector                                &q)
    {
      double sum = 0.;
      for (unsigned int i = 0; i < nodes.size(); ++i)
        for (unsigned int j = 0; j < nodes.size(); ++j)
          for (unsigned int c = 0; c < 3; ++c)
            sum += m(i, j) * a[3 * nodes[i] + c] * q[3 * nodes[j] + c];
      return sum;
    }

    void
    add_masses(const Problem    &problem,
               const Direction  &direction,
               const Vector     &q,
               SlopeDerivatives &sums)
    {
      const FESpace &fe_space = problem.body.fe_space;
      const auto     m        = unit_matrix(fe_space, problem.parameters.material.mass_matrix);
      for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      {
        const double by_density
            = fe_space.cell_volume(cell) * product(fe_space.nodes(cell), m, direction.positions, q);
        sums.by_density[cell] += by_density;
        add_volume(fe_space, cell, problem.body.material.density(cell) * by_density,
                   sums.by_rest_positions);
      }
    }
  } // namespace

  void
  add_slope_of_inertia(const Problem     &problem,
                       const Direction   &direction,
                       SlopeDerivatives  &sums,
                       MotionDerivatives &of_motion)
  {
    const TimeIntegrator &integrator = *problem.actions.integrator;
    const double          factor     = integrator.mass_factor();
    const Vector          M_a        = problem.actions.mass->times(direction.positions);
    Vector                q          = problem.state.positions;
    q -= integrator.predicted_positions();
    q *= factor;
    add_masses(problem, direction, q, sums);
    sums.by_positions.add(factor, M_a);
    // q = gamma (gamma + a_M) (x - x_star) - gamma v_star, and v = gamma (x - x_star)
    of_motion.by_base = M_a;
    of_motion.by_base *= -factor;
    of_motion.by_base_velocities = M_a;
    of_motion.by_base_velocities *= -integrator.rate_factor();
    of_motion.by_mass_damping = M_a * problem.state.velocities;
  }
} // namespace Exemplar
