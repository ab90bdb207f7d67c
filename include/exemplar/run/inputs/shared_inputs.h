// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_shared_inputs_h
#define exemplar_shared_inputs_h

#include <exemplar/body/material.h>
#include <exemplar/body/supports.h>
#include <exemplar/mesh/mesh_part.h>
#include <exemplar/run/inputs/inputs.h>

#include <mpi.h>

#include <optional>
#include <vector>

namespace Exemplar
{
  struct SceneParameters;

  /// What a process has of a body that several share, beside its part of the Inputs.
  struct SharedBody
  {
    MeshPart                         mesh;
    std::vector<unsigned int>        patches;  ///< of each cell, as Patches wants it
    PaintedMaterial                  material; ///< read off the surface
    std::vector<std::vector<double>> shares;   ///< the same
    /// Of an interpolation.
    std::optional<StaticallyDeterminateSupport> support;
  };

  /// Throws UserError if the scene asks for something that processes cannot share.
  void
  check_shareable(const SceneParameters &scene);

  /// read_inputs() by the root of a communicator, which gives each process its part of them, one
  /// after the other: Inputs::shared, and poses and nodes of this process' nodes; the nodes of all
  /// selections are there by their text. Cells are partitioned by METIS, patches of cells stay
  /// whole. All processes must call it. Throws UserError, the same on all, as read_inputs() and for
  /// more processes than the mesh has cells for.
  Inputs
  read_shared_inputs(const SceneParameters &scene,
                     MPI_Comm               communicator,
                     const Announce        &announce = {});
} // namespace Exemplar

#endif
