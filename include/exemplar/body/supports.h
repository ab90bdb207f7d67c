// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_supports_h
#define exemplar_supports_h

#include <exemplar/body/fe_space.h>

#include <deal.II/lac/vector.h>

#include <array>
#include <limits>
#include <vector>

namespace Exemplar
{
  // Functions that take a mesh or an exchange are collective. Those with `n_places` leave the nodes from that number on alone, which
  // are no places: NodeNumbering::n_places().

  constexpr unsigned int all_places = std::numeric_limits<unsigned int>::max();

  /// How many of the six rigid motions of each piece of the mesh the held degrees of freedom (3 i + c) leave free. Pieces
  /// that are joined to the same one move as one, and have their number there; empty: none are. Tips that follow their edges
  /// only hold the turn about these; `tips` may be empty where none do.
  std::vector<unsigned int>
  n_free_rigid_motions(const Mesh                      &mesh,
                       const FESpace                   &fe_space,
                       const std::vector<unsigned int> &held_dofs,
                       const std::vector<unsigned int> &joined = {},
                       const HeldTips                  &tips   = {});

  /// Six degrees of freedom of one cell that hold a body against rigid motion and
  /// nothing else: three of its first node, two of the second, one of the third. Nodes are those of
  /// the whole body.
  struct StaticallyDeterminateSupport
  {
    std::array<unsigned int, 4> corners;   ///< nodes of the cell; of a triangle the first one twice
    std::array<dealii::Point<3>, 4> rest;  ///< their positions at rest [m]
    std::array<unsigned int, 3>     nodes; ///< the nodes with held degrees of freedom
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

  /// The same of the triangles of a shell.
  StaticallyDeterminateSupport
  support_near_centroid(const std::vector<dealii::Point<3>>            &nodes,
                        const std::vector<std::array<unsigned int, 3>> &triangles);

  /// Rotate `positions` so that the supported cell has its orientation at rest, unless it deviates
  /// from that by less than `angle` [rad]. The support was chosen for that orientation and is a
  /// poor one in others. Returns whether they were rotated.
  bool
  turn_to_support(const StaticallyDeterminateSupport &support,
                  double                              angle,
                  dealii::Vector<double>             &positions,
                  const Exchange                     &exchange,
                  unsigned int                        n_places = all_places);

  /// Subtract the best-fitting infinitesimal rigid motion (translation and rotation, least squares
  /// over the nodes) from a displacement [m] of `positions`.
  void
  remove_rigid_motion(const dealii::Vector<double> &positions,
                      dealii::Vector<double>       &displacement,
                      const Exchange               &exchange,
                      unsigned int                  n_places = all_places);

  /// Move `positions` rigidly so that they come nearest to `reference` in the least-squares sense
  /// over the nodes (Kabsch 1976), Eq. (15).
  void
  align(const dealii::Vector<double> &reference,
        dealii::Vector<double>       &positions,
        const Exchange               &exchange,
        unsigned int                  n_places = all_places);

  /// align() by those nodes alone that have all three components among `dofs` on some process, or
  /// by all nodes if these are collinear or fewer than three.
  void
  align_at(const std::vector<unsigned int> &dofs,
           const dealii::Vector<double>    &reference,
           dealii::Vector<double>          &positions,
           const Exchange                  &exchange);
} // namespace Exemplar

#endif
