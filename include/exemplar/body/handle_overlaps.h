// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_handle_overlaps_h
#define exemplar_handle_overlaps_h

#include <exemplar/body/handle.h>

#include <set>
#include <vector>

namespace Exemplar
{
  /// Nodes that more than one handle holds.
  std::set<unsigned int>
  shared_nodes(const std::vector<Handle> &handles);

  /// Throws UserError if handles move a node that they share differently, by their displacements at
  /// time t [s]; the same on all processes. This and the next are collective.
  void
  check_agreement(const std::vector<Handle>                            &handles,
                  const std::set<unsigned int>                         &shared,
                  const std::vector<std::vector<dealii::Tensor<1, 3>>> &displacements,
                  double                                                time,
                  const Mesh                                           &mesh,
                  const FESpace                                        &fe_space);

  /// Throws UserError if a handle shares caught nodes with another one at time t [s]; times of
  /// steps may be off by `rounding` [s].
  void
  refuse_shared_catches(const std::vector<Handle> &handles,
                        double                     time,
                        double                     rounding,
                        const Mesh                &mesh,
                        const FESpace             &fe_space);
} // namespace Exemplar

#endif
