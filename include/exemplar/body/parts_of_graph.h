// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_parts_of_graph_h
#define exemplar_parts_of_graph_h

#include <array>
#include <vector>

namespace Exemplar
{
  /// Connected parts of a graph of nodes in which densities have bumps of their own. `edges` have two nodes
  /// each, `measures` the size of each node, and `densities` a list of numbers not less than 0, one a node, for
  /// each of some quantities whose sums of measure times density are 1. Returns the part of each node, counted
  /// from 0 by descending size.
  ///
  /// Each node belongs to the bump that the steepest way up leads to among nodes with the same greatest density
  /// (a watershed). Two bumps are as alike as the square root of how high the pass between them is, over the
  /// lower peak, times the cosine between the roots of what they hold of the quantities; the most alike join
  /// until none are by more than `least_likeness`. Bumps with less than 5 % of each quantity join first.
  std::vector<unsigned int>
  parts_of_graph(const std::vector<std::array<unsigned int, 2>> &edges,
                 const std::vector<double>                      &measures,
                 const std::vector<std::vector<double>>         &densities,
                 double                                          least_likeness = 0.6);
} // namespace Exemplar

#endif
