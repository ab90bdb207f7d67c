// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_contact_slopes_h
#define exemplar_contact_slopes_h

#include <exemplar/potential/contact_forces.h>

#include <vector>

// The slope of a touch along changes a of its nodes' positions, the sum of a_i.f_i with the derivatives f_i of its
// energy by positions, and the derivatives of that by all that it depends on, for gradients.

namespace Exemplar
{
  /// Derivatives of the slope of a contact at fixed a.
  struct ContactSlope
  {
    ContactGradient by_positions{};
    ContactGradient by_start{};        ///< by what slips are counted from at the nodes
    double          by_stiffness = 0.; ///< by the full k
    double          by_width     = 0.;
    double          by_distance  = 0.; ///< at fixed nearest points: what a radius takes off
    double by_square      = 0.; ///< by the logarithm of the square of an edge of the body at rest
    double by_coefficient = 0.; ///< of friction
  };

  /// Derivatives of the slope of the barrier. The distance must be positive.
  ContactSlope
  slope_of_barrier(const Touch &touch, const ContactGradient &along);

  /// How a contact that rubs has moved since the step has begun.
  struct ContactMotion
  {
    SpaceVector3    slip;   ///< relative to the obstacle's point, with what is along the normal [m]
    ContactGradient places; ///< of the nodes [m]
    ContactGradient ways;   ///< what they have gone [m]
    /// What changes the slip if another point of the obstacle is nearest.
    dealii::Tensor<2, 3> by_point;
  };

  /// Add derivatives of the slope of friction whose normal force, direction and places are those of the contact as it is
  /// now: forces that are no energy's derivative. `energy` has that normal force.
  void
  add_slope_of_friction(const Contact         &contact,
                        const SlipEnergy      &energy,
                        double                 coefficient,
                        const ContactMotion   &motion,
                        const ContactGradient &along,
                        ContactSlope          &slope);

  /// Derivatives of the slope of a term of what touches, along a displacement.
  struct TouchingSlopes
  {
    /// Zeros, but for what friction has.
    TouchingSlopes(const std::size_t n_dofs, const std::size_t n_cells)
        : by_positions(n_dofs), by_young(n_cells), by_rest_positions(n_dofs),
          by_first_positions(n_dofs)
    {
    }

    Vector              by_positions;
    Vector              by_start; ///< by what slips are counted from; empty without friction
    std::vector<double> by_young; ///< by cell
    Vector by_rest_positions;     ///< those in the middles of edges are numbers of their own
    Vector by_first_positions;    ///< by those from which pairs have widths of their own

    /// By what an obstacle is.
    struct OfObstacle
    {
      SpaceVector3 by_place; ///< by a displacement at all times, the start included
      double       by_radius = 0., by_coefficient = 0.;
    };

    std::vector<OfObstacle> of_obstacles; ///< empty for bodies
  };

  /// The values of a field at the nodes of a gap.
  ContactGradient
  at_nodes(const Gap &gap, const Vector &field);

  /// Add to a field at the nodes of a gap.
  void
  add_at_nodes(const Gap &gap, const ContactGradient &derivatives, Vector &to);
} // namespace Exemplar

#endif
