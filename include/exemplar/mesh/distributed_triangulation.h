// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_distributed_triangulation_h
#define exemplar_distributed_triangulation_h

#include <exemplar/algebra/exchange.h>
#include <exemplar/mesh/mesh_arrays.h>

#include <deal.II/grid/tria.h>

#include <memory>

namespace Exemplar
{
  /// deal.II's parallel::fullydistributed::Triangulation of the cells of this process, in their
  /// order, with their indices in the whole mesh as numbers of coarse cells. It has no ghost cells:
  /// contributions of several processes' cells to a node are summed by nodes. Collective on
  /// `exchange`, which is one over MPI.
  std::unique_ptr<dealii::Triangulation<3>>
  make_distributed_triangulation(const MeshArrays                &part,
                                 const std::vector<unsigned int> &cells_in_file,
                                 const Exchange                  &exchange);
} // namespace Exemplar

#endif
