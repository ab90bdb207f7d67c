// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_body_measures_h
#define exemplar_body_measures_h

#include <array>
#include <limits>

namespace Exemplar
{
  struct Body;
  class Exchange;

  /// The interval that values lie in; empty at first.
  struct Range
  {
    double minimum = std::numeric_limits<double>::infinity();
    double maximum = -std::numeric_limits<double>::infinity();

    void
    add(double value);

    /// The range over all processes, which must all call it.
    Range
    over(const Exchange &exchange) const;
  };

  /// Measures of the body, which a user can compare with the intended ones.
  struct BodyMeasures
  {
    std::array<double, 3> size; ///< of the bounding box [m]
    double                volume;
    double                area;       ///< of the boundary [m^2]
    double                mass;       ///< [kg]
    Range                 young;      ///< Young's modulus of the cells [Pa]
    Range                 poisson;    ///< Poisson's ratio of the cells
    Range                 density;    ///< of the cells [kg/m^3]
    double                soft_young; ///< harmonic mean of Young's modulus over the volume [Pa]

    /// The greatest extent of the bounding box [m].
    double
    length() const;

    /// Four times volume over area [m], about the thickness of long parts; exact for long square
    /// bars.
    double
    thickness() const
    {
      return 4. * volume / area;
    }

    /// Weight relative to stiffness: rho g / E [1/m] at an acceleration g [m/s^2].
    double
    weight_over_stiffness(double gravity) const
    {
      return mass / volume * gravity / soft_young;
    }
  };

  /// The measures of the body at rest. All processes that share it must call this.
  BodyMeasures
  measure(const Body &body);
} // namespace Exemplar

#endif
