// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_pose_checks_h
#define exemplar_pose_checks_h

#include <exemplar/body/fe_space.h>
#include <exemplar/mesh/mesh.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Checks a pose by its size and its cells' volumes: collapsed, in other units, flat, mirrored,
  /// with inverted cells, or, unless it `may_be_rest`, the rest pose moved rigidly; a shell, which may be flat
  /// and folded, by its size and strain alone. `positions` [m]
  /// are by degree of freedom. Returns a clause that follows the pose's name in a warning; empty if
  /// nothing looks wrong. Collective.
  std::string
  describe_pose(const Mesh                   &mesh,
                const FESpace                &fe_space,
                const dealii::Vector<double> &positions,
                bool                          may_be_rest = false);

  /// Checks whether a pose function that makes the body flat may be meant as displacements: at
  /// least two of its formulas lack their own coordinate. Returns a clause that follows its key;
  /// empty otherwise. Collective.
  std::string
  describe_displacements(const std::string            &functions,
                         const Mesh                   &mesh,
                         const FESpace                &fe_space,
                         const dealii::Vector<double> &positions);
} // namespace Exemplar

#endif
