// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/nodal_vectors.h>
#include <exemplar/potential/obstacle_term.h>

#include <cmath>

// The work that moving obstacles do, for the audit of energies.

namespace Exemplar
{
  namespace
  {
    /// The vector of a rotation by less than pi [rad].
    SpaceVector3
    vector_of(const dealii::Tensor<2, 3> &rotation)
    {
      const SpaceVector3 sine   = dealii::Point<3>(0.5 * (rotation[2][1] - rotation[1][2]),
                                                 0.5 * (rotation[0][2] - rotation[2][0]),
                                                 0.5 * (rotation[1][0] - rotation[0][1]));
      const double       norm   = sine.norm();
      const double       cosine = 0.5 * (dealii::trace(rotation) - 1.);
      return norm > 0. ? std::atan2(norm, cosine) / norm * sine : SpaceVector3();
    }
  } // namespace

  std::vector<std::pair<SpaceVector3, SpaceVector3>>
  ObstacleTerm::pushes(const Vector &positions) const
  {
    std::vector<std::pair<SpaceVector3, SpaceVector3>> result(standing.size());
    visit_gradients(
        positions,
        [&](const unsigned int obstacle, const Gap &gap, const ContactGradient &gradient)
        {
          for (unsigned int i = 0; i < gap.n_nodes; ++i)
          {
            const SpaceVector3 arm
                = at_node(positions, gap.nodes[i]) - standing[obstacle].pose.place;
            result[obstacle].first -= gradient[i];
            result[obstacle].second -= dealii::cross_product_3d(arm, gradient[i]);
          }
        });
    return result;
  }

  std::optional<EnergyFlow>
  ObstacleTerm::energy_flow(const State &start, const State &end) const
  {
    EnergyFlow flow;
    flow.lost = energy_of_friction(end.positions);
    if (!obstacles.move_between(start.time, end.time))
      return flow;
    const auto at_end = pushes(end.positions);
    for (unsigned int i = 0; i < standing.size(); ++i)
    {
      const Obstacle &obstacle = obstacles.all[i];
      if (!obstacle.moves_between(start.time, end.time))
        continue;
      if (obstacle.deforms())
        return {}; // its parts do work of their own
      const ObstaclePose before = obstacle.pose(start.time), after = obstacle.pose(end.time);
      const SpaceVector3 way      = after.place - before.place;
      const SpaceVector3 turn     = vector_of(after.rotation * dealii::transpose(before.rotation));
      const double       by_start = sums_of[i].force * way + sums_of[i].torque * turn;
      const double       by_end   = at_end[i].first * way + at_end[i].second * turn;
      flow.work += 0.5 * (by_start + by_end);
      flow.doubt += 0.5 * std::abs(by_end - by_start);
    }
    return flow;
  }
} // namespace Exemplar
