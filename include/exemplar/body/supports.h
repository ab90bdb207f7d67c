// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_supports_h
#define exemplar_supports_h

#include <exemplar/mesh/mesh.h>

#include <deal.II/lac/vector.h>

#include <array>
#include <vector>

namespace Exemplar
{
  // All processes that share a body must call functions that take a mesh or an exchange.

  /// Number of the six rigid motions that the held degrees of freedom (3 i + c)
  /// leave free, of nodes that are at `rest_positions` at rest.
  unsigned int
  n_free_rigid_motions(const Mesh                      &mesh,
                       const dealii::Vector<double>    &rest_positions,
                       const std::vector<unsigned int> &held_dofs);

  /// Six degrees of freedom of one cell that hold a body against rigid motion and
  /// nothing else: three of its first node, two of the second, one of the third. Nodes are those of
  /// the whole body.
  struct StaticallyDeterminateSupport
  {
    std::array<unsigned int, 4>     corners;   ///< of the cell
    std::array<dealii::Point<3>, 4> rest;      ///< where these are at rest [m]
    std::array<unsigned int, 3>     nodes;     ///< with held degrees of freedom
    std::vector<unsigned int>       held_dofs; ///< ascending

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &corners &rest &nodes &held_dofs;
    }
  };

  /// The support in the cell nearest to the centroid of the nodes of a whole body.
  StaticallyDeterminateSupport
  support_near_centroid(const std::vector<dealii::Point<3>>            &nodes,
                        const std::vector<std::array<unsigned int, 4>> &cells);

  /// Turn `positions` so that the supported cell stands as it does at rest, unless it
  /// deviates from that by less than `angle` [rad]. The support was chosen for that
  /// orientation and is a poor one in others. Returns whether they were turned.
  bool
  turn_to_support(const StaticallyDeterminateSupport &support,
                  double                              angle,
                  dealii::Vector<double>             &positions,
                  const Exchange                     &exchange);

  /// Take the best-fitting infinitesimal rigid motion (translation and rotation, least
  /// squares over the nodes) out of a displacement [m] of `positions`.
  void
  remove_rigid_motion(const dealii::Vector<double> &positions,
                      dealii::Vector<double>       &displacement,
                      const Exchange               &exchange);

  /// Move `positions` rigidly so that it comes nearest to `reference` in the
  /// least-squares sense over the nodes (Kabsch 1976), Eq. (15).
  void
  align(const dealii::Vector<double> &reference,
        dealii::Vector<double>       &positions,
        const Exchange               &exchange);

  /// The same by the nodes alone of which all three of these degrees of freedom of this process are there,
  /// unless they are on a line.
  void
  align_at(const std::vector<unsigned int> &dofs,
           const dealii::Vector<double>    &reference,
           dealii::Vector<double>          &positions,
           const Exchange                  &exchange);
} // namespace Exemplar

#endif
