// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_contact_forces_h
#define exemplar_contact_forces_h

#include <exemplar/algebra/free_dofs.h>
#include <exemplar/algebra/spd_operator.h>
#include <exemplar/obstacles/contact_points.h>
#include <exemplar/potential/contact_search.h>
#include <exemplar/potential/evaluation.h>

#include <array>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// Derivatives by the nodes of a pair that touches, of which there are at most four.
  using ContactGradient = std::array<SpaceVector3, 4>;
  using ContactHessian  = std::array<std::array<dealii::Tensor<2, 3>, 4>, 4>;

  /// The energy of a pair's barrier [J].
  double
  energy_of(const Touch &touch);

  /// Its derivative [N].
  ContactGradient
  gradient_of(const Touch &touch);

  /// Its second derivative [N/m], or what is nearest to it of all that is not indefinite.
  ContactHessian
  hessian_of(const Touch &touch, Tangent kind);

  /// Inverse of the Gram matrix of dv, the second derivative of v^2 / 2 by the free parameters [1/m^2]; those of parallel
  /// edges are one.
  dealii::Tensor<2, 2>
  inverse_of_free(const Nearest &at);

  /// The gap with the nodes that its points are made of.
  Gap
  on_nodes(const Gap &gap, const ContactPoints &points);

  /// Add the blocks of a gap's points to the values of a matrix.
  void
  add_blocks(const Gap              &gap,
             const ContactHessian   &blocks,
             const ContactPoints    &points,
             const SymmetricPattern &pattern,
             const FreeDofs         &free_dofs,
             std::vector<double>    &values);

  /// Add the blocks times a displacement to a field.
  void
  add_products(const Gap            &gap,
               const ContactHessian &blocks,
               const ContactPoints  &points,
               const Vector         &displacement,
               Vector               &field);

  /// The rounding of the distance of a gap of a body whose greatest coordinate is `size` [m].
  double
  rounding_of_distance(const Gap &gap, double size);

  /// The greatest force at a node, at these positions, that is nothing but the rounding of distances [N].
  double
  rounding_force_of(const std::vector<Gap> &gaps, const Vector &positions);

  /// What rubs at a contact, with the normal force that it had when this was found.
  struct Rubbing
  {
    unsigned int obstacle;
    PairKey      key;
    Gap          gap;         ///< of which nodes, coefficients and normal serve
    double       force;       ///< normal force [N]
    double       coefficient; ///< of friction [-]
    SpaceVector3 own_place;   ///< the obstacle's point, in its axes [m]
    /// Where that point is between vertices that move by themselves.
    std::array<unsigned int, 3> vertices;
    std::array<double, 3>       shares;
  };

  /// The greatest normal force of what rubs, and the greatest difference to earlier ones; both lists ascend with obstacles and keys.
  std::pair<double, double>
  force_and_change_of(const std::vector<Rubbing> &now, const std::vector<Rubbing> &before);

  /// Coulomb's friction of a contact for a slip u [m] along the obstacle: mu lambda f(|u|), smooth below a slip e [m]: f' = 2 y / e - (y / e)^2 there and 1 beyond.
  struct SlipEnergy
  {
    double greatest; ///< mu lambda [N]
    double e;        ///< [m]

    /// [J]
    double
    value(double slip) const;

    /// mu lambda f'(y) / y [N/m], which has a value at y = 0.
    double
    force_by_slip(double slip) const;

    /// The second derivative by u without what is along the normal [N/m].
    dealii::Tensor<2, 3>
    curvature(const SpaceVector3 &slip, const SpaceVector3 &normal) const;

    /// Heat of a step that slips by y [J].
    double
    heat(const double slip) const
    {
      return force_by_slip(slip) * slip * slip;
    }
  };
} // namespace Exemplar

#endif
