// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_contact_forces_h
#define exemplar_contact_forces_h

#include <exemplar/potential/contact_search.h>
#include <exemplar/potential/evaluation.h>

#include <array>
#include <vector>

namespace Exemplar
{
  /// Derivatives by the nodes of a contact, of which there are at most three.
  using ContactGradient = std::array<SpaceVector3, 3>;
  using ContactHessian  = std::array<std::array<dealii::Tensor<2, 3>, 3>, 3>;

  /// The energy of a contact's barrier [J].
  double
  energy_of(const Contact &contact);

  /// Its derivative [N].
  ContactGradient
  gradient_of(const Contact &contact);

  /// Its second derivative [N/m], or without the curvature of the distance, which is never indefinite.
  ContactHessian
  hessian_of(const Contact &contact, Tangent kind);

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
