// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_shared_body_h
#define exemplar_shared_body_h

#include <exemplar/run/inputs/body_inputs.h>

#include <mpi.h>

namespace Exemplar
{
  /// Throws UserError if the scene asks for something that processes cannot share.
  void
  check_shareable(const SceneParameters &scene);

  /// read_body() by the root of a communicator, which gives each process its part, one after the other.
  /// Cells are partitioned by METIS, patches of cells stay whole. All processes must call it. Throws
  /// UserError, the same on all, as read_body() and for more processes than the mesh has cells for.
  BodyInputs
  read_shared_body(const CompleteScene &scene,
                   MPI_Comm             communicator,
                   const Announce      &announce = {});
} // namespace Exemplar

#endif
