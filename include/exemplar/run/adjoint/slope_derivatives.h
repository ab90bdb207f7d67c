// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_slope_derivatives_h
#define exemplar_slope_derivatives_h

#include <exemplar/kernels/symmetric.h>
#include <exemplar/run/problem/problem.h>

#include <array>
#include <vector>

namespace Exemplar
{
  /// Changes of positions [m], by degree of freedom, and of weights.
  struct Direction
  {
    Vector              positions;
    std::vector<double> weights;
  };

  /// Of the slope of the potential along a direction (a, b), a.dPhi/dx + b.dPhi/dw, the derivatives by all that
  /// the potential depends on, at fixed a and b. Those by the state are Phi'' (a, b).
  struct SlopeDerivatives
  {
    Vector              by_positions; ///< by degree of freedom, held ones too
    std::vector<double> by_weights;
    Vector              by_rest_positions;
    std::vector<Vector> by_poses; ///< of all examples
    /// By the strains of examples, by point and of all of them: what by_poses and by_rest_positions lack until
    /// carry_strains_to_poses(); empty thereafter.
    std::vector<SymmetricEntries<double>> by_strains;
    std::vector<double>                   by_young, by_poisson, by_density; ///< by cell
    double                                by_importance = 0.;
    Vector                                by_nodal_forces;
    std::array<double, 3>                 by_gravity{};
  };

  class ExampleStrains;

  /// Of a static problem that adjoint_checks.h knows, whose examples have these strains.
  SlopeDerivatives
  derivatives_of_slope(const Problem        &problem,
                       const ExampleStrains &strains,
                       const Direction      &direction);
} // namespace Exemplar

#endif
