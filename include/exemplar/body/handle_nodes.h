// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_handle_nodes_h
#define exemplar_handle_nodes_h

#include <exemplar/body/fe_space.h>

#include <functional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Where a program moves a handle: the displacements [m] at time t [s] of points that are at
  /// `rest` [m] at rest, one for each. May be called several times for one t.
  using Motion = std::function<std::vector<dealii::Tensor<1, 3>>(
      const std::vector<dealii::Point<3>> &rest, double time)>;

  /// A motion of the nodes of the mesh file among some (ascending), and that of the middles of
  /// edges as the means of their ends.
  Motion
  at_middles_too(const Motion                    &motion,
                 const std::vector<unsigned int> &nodes,
                 const FESpace                   &fe_space);

  /// The places of all of a handle's nodes, of which this process has those given. All processes must
  /// call this and the next.
  std::vector<dealii::Point<3>>
  whole_handle(const std::vector<unsigned int>     &nodes,
               const std::vector<dealii::Point<3>> &places,
               const FESpace                       &fe_space);

  /// The number of each of these nodes among all of the handle.
  std::vector<unsigned int>
  places_in_whole(const std::vector<unsigned int> &nodes, const FESpace &fe_space);

  /// The mesh file's number of a node, or those of the ends of its edge.
  std::string
  name_of_node(unsigned int node, const Mesh &mesh, const FESpace &fe_space);
} // namespace Exemplar

#endif
