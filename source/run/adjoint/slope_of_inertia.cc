// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/adjoint/slope_of_motion.h>
#include <exemplar/run/adjoint/slope_terms.h>

namespace Exemplar
{
  namespace
  {
    /// sum_ij m_ij a_i.q_j over the nodes of a cell with a mass of 1.
    double
    product_in_cell(const dealii::ArrayView<const unsigned int> &nodes,
                    const MassMatrix                             kind,
                    const Vector                                &a,
                    const Vector                                &q)
    {
      double of_nodes = 0., of_sums = 0.;
      for (unsigned int c = 0; c < 3; ++c)
      {
        double sum_a = 0., sum_q = 0.;
        for (const unsigned int node : nodes)
        {
          of_nodes += a[3 * node + c] * q[3 * node + c];
          sum_a += a[3 * node + c];
          sum_q += q[3 * node + c];
        }
        of_sums += sum_a * sum_q;
      }
      return kind == MassMatrix::lumped ? of_nodes / 4. : (of_nodes + of_sums) / 20.;
    }

    void
    add_masses(const Problem    &problem,
               const Direction  &direction,
               const Vector     &q,
               SlopeDerivatives &sums)
    {
      const FESpace &fe_space = problem.body.fe_space;
      for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      {
        const auto   nodes  = fe_space.nodes(cell);
        const double volume = fe_space.volume(cell);
        const double product
            = volume
              * product_in_cell({ nodes.data(), nodes.size() },
                                problem.parameters.material.mass_matrix, direction.positions, q);
        sums.by_density[cell] += product;
        add_forces(fe_space, cell,
                   combine(problem.body.material.density(cell) * product, identity_matrix<double>(),
                           0., {}),
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
