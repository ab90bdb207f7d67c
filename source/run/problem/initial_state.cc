// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/agreement.h>
#include <exemplar/prm/expression.h>
#include <exemplar/run/problem/initial_state.h>

namespace Exemplar
{
  namespace
  {
    Vector
    with_tips_of_least_bending(const Vector &positions, const FESpace &fe_space)
    {
      std::vector<dealii::Point<3>> places;
      for (unsigned int node = 0; node < fe_space.numbering().n_places(); ++node)
        places.emplace_back(positions[3 * node], positions[3 * node + 1], positions[3 * node + 2]);
      places = fe_space.complete(std::move(places), "Initial/Pose function");
      Vector all(positions.size());
      for (unsigned int dof = 0; dof < all.size(); ++dof)
        all[dof] = places[dof / 3][dof % 3];
      return all;
    }
  } // namespace

  State
  initial_state(const InitialParameters &parameters,
                const Mesh              &mesh,
                const FESpace           &fe_space,
                const ExampleWeights    &weights,
                const bool               dynamic,
                const NamedPoses        &poses)
  {
    State state;
    state.positions           = fe_space.rest_positions();
    const auto set_node_field = [&](const Expression &expression, dealii::Vector<double> &field)
    {
      const auto set = [&]
      {
        for (unsigned int node = 0; node < fe_space.numbering().n_places(); ++node)
        {
          const dealii::Tensor<1, 3> value = expression.vector(fe_space.rest_position(node), 0.);
          for (unsigned int c = 0; c < 3; ++c)
            field[3 * node + c] = value[c];
        }
      };
      do_in_agreement(fe_space.exchange(), set); // a formula may fail in one process alone
    };
    if (!parameters.pose.empty())
    {
      const auto nodes = fe_space.complete(mesh.find_pose(poses, parameters.pose, "Initial/Pose"),
                                           "Initial/Pose");
      for (unsigned int dof = 0; dof < fe_space.n_dofs(); ++dof)
        state.positions[dof] = nodes[dof / 3][dof % 3];
    }
    else if (!parameters.pose_function.empty())
    {
      set_node_field(Expression("Initial/Pose function", parameters.pose_function, "xyz", 3),
                     state.positions);
      if (fe_space.numbering().has_slopes())
        state.positions = with_tips_of_least_bending(state.positions, fe_space);
    }
    if (dynamic)
    {
      state.velocities.reinit(fe_space.n_dofs());
      set_node_field(Expression("Initial/Velocity", parameters.velocity, "xyz", 3),
                     state.velocities);
    }
    state.weights = weights.initial();
    state.multipliers.assign(weights.weight_form().N.m(), 0.);
    return state;
  }
} // namespace Exemplar
