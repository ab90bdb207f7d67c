// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_part_h
#define exemplar_mesh_part_h

#include <exemplar/algebra/exchange.h>
#include <exemplar/mesh/mesh_arrays.h>

#include <memory>
#include <set>

namespace Exemplar
{
  /// Facts of a whole body of which a process may have a part.
  struct WholeMesh
  {
    unsigned int           n_nodes  = 0;
    unsigned int           n_cells  = 0;
    double                 diameter = 0.; ///< of the bounding box [m]
    std::set<unsigned int> material_ids;

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &n_nodes &n_cells &diameter &material_ids;
    }
  };

  /// What a process has of a mesh that several share: its cells, and the nodes of these, both in the
  /// order of the file.
  struct MeshPart
  {
    WholeMesh                       whole;
    MeshArrays                      arrays;        ///< without elements
    std::vector<unsigned int>       cells_in_file; ///< index of each cell in the whole
    std::shared_ptr<const Exchange> exchange;      ///< with the others
    /// The file as read (scaled), at the root; null elsewhere.
    std::shared_ptr<const MshFile> contents_of_whole;
  };
} // namespace Exemplar

#endif
