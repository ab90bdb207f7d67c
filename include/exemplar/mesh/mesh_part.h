// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_part_h
#define exemplar_mesh_part_h

#include <exemplar/algebra/exchange.h>
#include <exemplar/mesh/mesh_arrays.h>

#include <memory>
#include <set>
#include <vector>

namespace Exemplar
{
  class Mesh;

  /// Facts of a whole body of which a process may have a part.
  struct WholeMesh
  {
    unsigned int           n_nodes  = 0;
    unsigned int           n_cells  = 0;
    double                 diameter = 0.; ///< diagonal of the bounding box [m]
    std::set<unsigned int> material_ids;
    MeshPieces             pieces;

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &n_nodes &n_cells &diameter &material_ids &pieces.of_cells &pieces.first_elements;
    }
  };

  /// The part of a process of a distributed mesh: its cells, and their nodes, both in the order of
  /// the file.
  struct MeshPart
  {
    WholeMesh                       whole;
    MeshArrays                      arrays;        ///< without elements
    std::vector<unsigned int>       cells_in_file; ///< index of each cell in the whole
    std::shared_ptr<const Exchange> exchange;      ///< exchange with the other parts
    /// The file as read (scaled), at the root; null elsewhere.
    std::shared_ptr<const MshFile> contents_of_whole;

    /// The members that the root sends.
    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      MshFile                       &contents = arrays.contents;
      archive &whole &cells_in_file &contents.node_numbers &contents.nodes &contents.physical_names;
      archive &arrays.cells &arrays.material_ids &arrays.element_numbers &arrays
          .boundary_faces                                                &arrays.further_faces;
    }
  };

  /// The entries of a list at `places`.
  template <typename T>
  std::vector<T>
  chosen(const std::vector<T> &all, const std::vector<unsigned int> &places)
  {
    std::vector<T> some;
    some.reserve(places.size());
    for (const unsigned int place : places)
      some.push_back(all[place]);
    return some;
  }

  /// The part of a whole mesh with these nodes, ascending, and with cells, boundary faces and further faces on
  /// these nodes only. Its exchange is not set.
  MeshPart
  part_of(const Mesh                      &whole,
          const std::vector<unsigned int> &nodes,
          const std::vector<unsigned int> &cells,
          const std::vector<unsigned int> &faces,
          const std::vector<unsigned int> &further_faces);

  /// The cells of a body that a process has, and the exchange of cell data with the whole body.
  class CellOrder
  {
  public:
    /// `in_file` are the indices of this process' cells among the `n_cells` of the body, ascending.
    /// `exchange` must outlive this.
    CellOrder(std::vector<unsigned int> in_file, unsigned int n_cells, const Exchange &exchange);

    /// Indices of this process' cells in the order of the file.
    const std::vector<unsigned int> &
    in_file() const
    {
      return places;
    }

    /// Gather values of the cells, equally many each, for the whole body in the order of its file,
    /// the same on all processes. Collective.
    std::vector<double>
    whole(const std::vector<double> &own) const;

    /// The values of a whole() in this process' cells.
    std::vector<double>
    part(const std::vector<double> &of_whole_body) const;

  private:
    std::vector<unsigned int> places;
    unsigned int              n_of_whole;
    const Exchange           *exchange;
  };
} // namespace Exemplar

#endif
