// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tip_frame_h
#define exemplar_tip_frame_h

#include <exemplar/body/shell_mesh.h>
#include <exemplar/kernels/hinge_angle.h>

#include <array>
#include <cstdint>
#include <vector>

// Directors of which handles hold fewer than three components, as in planes of symmetry.

namespace Exemplar
{
  /// The components of the tip of an edge's director that are held in space, component c by the bit 1 << c. 0: the slope is free.
  using HeldComponents = std::uint8_t;

  /// By edge of a plate.
  using HeldTips = std::vector<HeldComponents>;

  constexpr HeldComponents held_in_space = 7;

  /// Whether some components of a tip are held, and others follow the middle of its edge.
  constexpr bool
  follows_edge(const HeldComponents held)
  {
    return held != 0 && held != held_in_space;
  }

  /// How a director of which one or two components are held follows its edge. Its slope node has the tip's position as if the
  /// middle of the edge had stayed at rest in the components that are not held. A handle holds the angle between the shell and the
  /// director about the edge. Where the edge lies in a plane across a held axis, that axis takes the place of the normal: it is
  /// perpendicular to the edge, however far that turns in the plane, and the angle differs from the normal's by a constant.
  class TipFrame
  {
  public:
    TipFrame(const ShellMesh &mesh, unsigned int edge, HeldComponents held);

    /// The position that is the fourth node of the edge's hinges, for positions of the edge's ends and the slope node.
    Vector3<double>
    place(const Vector3<double> &begin,
          const Vector3<double> &end,
          const Vector3<double> &node) const;

    /// The derivatives with respect to the nodes, from those with respect to begin, end (in any order), opposite node and place().
    HingeForm<double>
    pulled_back(HingeForm<double> form) const;

    /// The position of the slope node for a tip of the normal: the inverse of place() if nothing turns.
    Vector3<double>
    node(const Vector3<double> &begin,
         const Vector3<double> &end,
         const Vector3<double> &tip) const;

    /// The angle [rad] by which the director has been turned out of the normal, about the edge from its begin to its end.
    double
    turned_by() const
    {
      return angle;
    }

  private:
    Vector3<double>
    anchor(const Vector3<double> &middle) const;

    double                angle = 0.;
    Matrix3<double>       turn; ///< by the angle, about the edge at rest
    Vector3<double>       middle_at_rest;
    std::array<double, 3> is_held; ///< 1 or 0, by component
  };
} // namespace Exemplar

#endif
