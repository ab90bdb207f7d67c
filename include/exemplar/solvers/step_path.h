// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_step_path_h
#define exemplar_step_path_h

#include <exemplar/algebra/free_dofs.h>
#include <exemplar/obstacles/closest_features.h>

#include <vector>

namespace Exemplar
{
  /// The positions x + s u along a step u for parts s of it, or a curve with this derivative at s = 0. On a straight line a piece
  /// that turns by an angle a is stretched by a^2 / 2. Where weak springs alone resist this turn, the energy of the stretch would leave
  /// steps of any useful length no descent. On the curve such pieces keep their shape: they turn along arcs.
  class StepPath
  {
  public:
    /// `pieces`: the piece of each node of this process, or empty if no piece turns. Pieces with held nodes do not turn.
    /// The free degrees of freedom must outlive the path. Collective.
    StepPath(const Vector                    &positions,
             Vector                           displacement,
             const std::vector<unsigned int> &pieces,
             const FreeDofs                  &free_dofs);

    bool
    is_straight() const
    {
      return motions.empty();
    }

    /// From now on s^2 times a displacement is part of the path.
    void
    bend(const Vector &displacement);

    /// The positions after a part of the step.
    Vector
    at(double part) const;

    /// The displacement after a part of the step.
    Vector
    way(double part) const;

    /// The derivative at the start.
    const Vector &
    derivative() const
    {
      return displacement;
    }

  private:
    /// The rigid motion of a piece that is nearest to its part of the step.
    struct Motion
    {
      SpaceVector3 centre, translation, turn; ///< [m], [m], [rad]
    };

    void
    find_motions(const FreeDofs &free_dofs);

    const Vector              start;
    const Vector              displacement;
    std::vector<unsigned int> pieces;
    std::vector<Motion>       motions; ///< of pieces; empty on a straight line
    Vector                    bent;    ///< empty: nothing
  };
} // namespace Exemplar

#endif
