// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_slope_derivatives_h
#define exemplar_slope_derivatives_h

#include <exemplar/kernels/symmetric.h>
#include <exemplar/potential/contact_slopes.h>
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

  /// Derivatives of the slope of the potential along a direction (a, b), a.dPhi/dx + b.dPhi/dw, by
  /// all data of the potential, at fixed a and b. The derivatives by the state are Phi'' (a, b).
  struct SlopeDerivatives
  {
    Vector              by_positions; ///< by degree of freedom, held ones included
    std::vector<double> by_weights;
    /// Without what by_gradients has, until carry_to_parameters().
    Vector              by_rest_positions;
    std::vector<Vector> by_poses; ///< of all examples
    /// Derivatives by the examples' strains, by point and example, that by_poses and
    /// by_rest_positions lack until carry_strains_to_poses(), which empties it.
    std::vector<SymmetricEntries<double>> by_strains;
    /// By the gradient of a field of changes of the rest positions, by cell; and by the first two
    /// constants of its law and the lambda that patches take of it, in this order. Both are emptied
    /// by carry_to_parameters().
    std::vector<Matrix3<double>>       by_gradients;
    std::vector<std::array<double, 3>> by_constants;
    std::vector<double>                by_young, by_poisson, by_density; ///< by cell
    std::vector<double>                by_tension; ///< of fibres, by cell; empty without
    /// By the thickness of the triangles of a shell; times it until carry_to_parameters(). Empty for solids.
    std::vector<double>   by_thickness;
    double                by_importance = 0.;
    Vector                by_nodal_forces;
    std::array<double, 3> by_gravity{};
    Vector
        by_start; ///< by what slips are counted from, x_star of the time scheme; empty without friction
    std::vector<TouchingSlopes::OfObstacle> of_obstacles; ///< empty without obstacles

    /// Add what follows from changes of the shape gradients of a cell: the derivative by F times
    /// F^T's, F^T by_F.
    void
    add_by_shape_gradients(const unsigned int cell, const Matrix3<double> &by_shape_gradients)
    {
      by_gradients[cell] = combine(1., by_gradients[cell], -1., by_shape_gradients);
    }

    /// Add what follows from a change of a cell's volume; `by_volume` is the volume times the
    /// derivative. The volume of a shell changes with its thickness.
    void
    add_by_volume(const unsigned int cell, const double by_volume)
    {
      if (!by_thickness.empty())
      {
        by_thickness[cell] += by_volume;
        return;
      }
      for (int i = 0; i < 3; ++i)
        by_gradients[cell][i][i] += by_volume;
    }
  };

  /// Chain rule: what all steps share is carried once, at the end, from strains, shape gradients
  /// and constants of laws to poses, rest positions and moduli.
  void
  carry_to_parameters(const Problem &problem, SlopeDerivatives &sums);

  class ExampleStrains;

  /// Derivatives for a static problem that satisfies adjoint_checks.h, whose examples have these
  /// strains.
  SlopeDerivatives
  derivatives_of_slope(Problem &problem, const ExampleStrains &strains, const Direction &direction);
} // namespace Exemplar

#endif
