// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_handle_nodes_h
#define exemplar_handle_nodes_h

#include <exemplar/body/fe_space.h>

#include <functional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// A handle's motion by a program: the displacements [m] at time t [s] of points that are at
  /// `rest` [m] at rest, one for each. May be called several times for one t.
  using Motion = std::function<std::vector<dealii::Tensor<1, 3>>(
      const std::vector<dealii::Point<3>> &rest, double time)>;

  /// Extend a motion of vertices to the middles of edges among `nodes` (ascending), by the means of
  /// the edges' ends.
  Motion
  at_middles_too(const Motion                    &motion,
                 const std::vector<unsigned int> &nodes,
                 const FESpace                   &fe_space);

  /// Gather the places of all of a handle's nodes; this process has those given. This and the next
  /// are collective.
  std::vector<dealii::Point<3>>
  whole_handle(const std::vector<unsigned int>     &nodes,
               const std::vector<dealii::Point<3>> &places,
               const FESpace                       &fe_space);

  /// Index of each of these nodes among all nodes of the handle.
  std::vector<unsigned int>
  places_in_whole(const std::vector<unsigned int> &nodes, const FESpace &fe_space);

  /// A node in words: its number in the mesh file, or those of the ends of its edge.
  std::string
  name_of_node(unsigned int node, const Mesh &mesh, const FESpace &fe_space);
} // namespace Exemplar

#endif
