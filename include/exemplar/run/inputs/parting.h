// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_parting_h
#define exemplar_parting_h

#include <exemplar/algebra/mpi_exchange.h>
#include <exemplar/body/fe_space.h>
#include <exemplar/mesh/mesh.h>

#include <vector>

namespace Exemplar
{
  /// Which cells, faces and nodes of a body one process has.
  struct PartOfBody
  {
    std::vector<unsigned int> cells;         ///< ascending
    std::vector<unsigned int> faces;         ///< of the boundary, ascending
    std::vector<unsigned int> further_faces; ///< indices into Mesh::get_further_faces(), ascending
    /// Nodes as in FESpace: those of the mesh file, then for quadratic elements those on edges.
    SharedNodes nodes;
  };

  /// Partition a whole body among processes by METIS, with cells of one patch kept together;
  /// `patches` has the patch of each cell, or is empty. Throws UserError if there are fewer cells
  /// or patches than processes.
  std::vector<PartOfBody>
  part_body(const Mesh                      &mesh,
            const std::vector<unsigned int> &patches,
            Element                          element,
            unsigned int                     n_processes);
} // namespace Exemplar

#endif
