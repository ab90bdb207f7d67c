// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_parting_h
#define exemplar_parting_h

#include <exemplar/algebra/mpi_exchange.h>
#include <exemplar/body/fe_space.h>
#include <exemplar/mesh/mesh.h>

#include <vector>

namespace Exemplar
{
  /// What one process gets of a body.
  struct PartOfBody
  {
    std::vector<unsigned int> cells; ///< ascending
    std::vector<unsigned int> faces; ///< of the boundary, the same
    /// As FESpace has them: those of the file and, of quadratic elements, those on edges behind them.
    SharedNodes nodes;
  };

  /// Part a whole body among processes. Cells are partitioned by METIS, those of one patch stay
  /// together; `patches` are those of the cells, or empty. Throws UserError for more processes than
  /// there are cells or patches for.
  std::vector<PartOfBody>
  part_body(const Mesh                      &mesh,
            const std::vector<unsigned int> &patches,
            Element                          element,
            unsigned int                     n_processes);
} // namespace Exemplar

#endif
