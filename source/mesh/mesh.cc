// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/exchange.h>
#include <exemplar/base/errors.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/mesh/mesh_arrays.h>
#include <exemplar/mesh/mesh_checks.h>

#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/grid/tria_accessor.h>
#include <deal.II/grid/tria_description.h>
#include <deal.II/grid/tria_iterator.h>

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

namespace Exemplar
{
  namespace
  {
    namespace Description = dealii::TriangulationDescription;

    Description::CellData<3>
    info_of(const unsigned int cell_in_file, const unsigned int process)
    {
      Description::CellData<3> info;
      info.id                 = dealii::CellId(cell_in_file, {}).to_binary<3>();
      info.subdomain_id       = process;
      info.level_subdomain_id = process;
      info.manifold_id        = dealii::numbers::flat_manifold_id;
      info.manifold_line_ids.fill(dealii::numbers::flat_manifold_id);
      info.manifold_quad_ids.fill(dealii::numbers::flat_manifold_id);
      return info;
    }

    /// deal.II's parallel::fullydistributed::Triangulation of the cells of this process, in their
    /// order, with their indices in the whole mesh as numbers of coarse cells. It has no ghost
    /// cells: contributions of several processes' cells to a node are summed by nodes. Collective
    /// on `exchange`, which is one over MPI.
    std::unique_ptr<dealii::Triangulation<3>>
    make_distributed_triangulation(const MeshArrays                &part,
                                   const std::vector<unsigned int> &cells_in_file,
                                   const Exchange                  &exchange)
    {
      const MPI_Comm                 communicator = exchange.communicator();
      Description::Description<3, 3> description;
      description.comm                 = communicator;
      description.settings             = Description::default_setting;
      description.smoothing            = dealii::Triangulation<3>::none;
      description.coarse_cell_vertices = part.contents.nodes;
      description.cell_infos.resize(1);
      for (std::size_t cell = 0; cell < part.cells.size(); ++cell)
      {
        dealii::CellData<3> data(4);
        std::copy(part.cells[cell].begin(), part.cells[cell].end(), data.vertices.begin());
        data.material_id = part.material_ids[cell];
        description.coarse_cells.push_back(std::move(data));
        description.coarse_cell_index_to_coarse_cell_id.push_back(cells_in_file[cell]);
        description.cell_infos[0].push_back(info_of(cells_in_file[cell], exchange.process()));
      }
      auto triangulation
          = std::make_unique<dealii::parallel::fullydistributed::Triangulation<3>>(communicator);
      triangulation->create_triangulation(description);
      return triangulation;
    }

    /// The corners opposite to each corner of a positive tetrahedron,
    /// counterclockwise seen from outside.
    constexpr unsigned int outward_faces[4][3]
        = { { 1, 2, 3 }, { 0, 3, 2 }, { 0, 1, 3 }, { 0, 2, 1 } };

    std::array<unsigned int, 3>
    outward_nodes(const CellFace &face, const std::array<unsigned int, 4> &cell)
    {
      const auto corner = static_cast<std::size_t>(
          std::find(cell.begin(), cell.end(), face.opposite) - cell.begin());
      std::array<unsigned int, 3> nodes;
      for (unsigned int v = 0; v < 3; ++v)
        nodes[v] = cell[outward_faces[corner][v]];
      return nodes;
    }

    /// The faces of one cell only, in the order of `faces`.
    std::vector<CellFace>
    extract_boundary(const std::vector<CellFace> &faces)
    {
      std::vector<CellFace> boundary;
      for (std::size_t i = 0; i < faces.size(); ++i)
        if (i + 1 < faces.size() && faces[i + 1].nodes == faces[i].nodes)
          ++i; // internal: skip both sides
        else
          boundary.push_back(faces[i]);
      return boundary;
    }

    /// Position of the face with these nodes in a sorted list, or its size.
    std::size_t
    find_face(const std::vector<CellFace> &faces, const std::array<unsigned int, 3> &nodes)
    {
      const auto face = std::lower_bound(faces.begin(), faces.end(), nodes,
                                         [](const CellFace &a, const std::array<unsigned int, 3> &b)
                                         { return a.nodes < b; });
      return (face != faces.end() && face->nodes == nodes)
                 ? static_cast<std::size_t>(face - faces.begin())
                 : faces.size();
    }

    std::array<unsigned int, 3>
    ascending_nodes(const MshElement &triangle)
    {
      std::array<unsigned int, 3> nodes;
      for (unsigned int v = 0; v < 3; ++v)
        nodes[v] = static_cast<unsigned int>(triangle.nodes[v]);
      std::sort(nodes.begin(), nodes.end());
      return nodes;
    }

    /// Boundary ids of the faces of one cell, from the file's physical triangles.
    class BoundaryIds
    {
    public:
      explicit BoundaryIds(const std::vector<CellFace> &all_faces)
          : faces(all_faces), boundary(extract_boundary(all_faces)), ids(boundary.size(), 0)
      {
      }

      void
      add(const MshElement &triangle, const int tag)
      {
        const auto        nodes = ascending_nodes(triangle);
        const auto        id    = static_cast<unsigned int>(std::abs(tag));
        const std::size_t face  = find_face(boundary, nodes);
        if (face < boundary.size())
        {
          of_boundary.insert(id);
          if (ids[face] == 0)
            ids[face] = id;
          else if (ids[face] != id)
            further.insert({ nodes, id, face });
        }
        else if (find_face(faces, nodes) < faces.size())
        {
          internal[id].push_back(triangle.number);
          further.insert({ nodes, id, boundary.size() });
        }
        else
          stray.push_back(triangle.number);
      }

      void
      report(const std::string &name, std::vector<std::string> &warnings) const
      {
        if (!stray.empty())
          throw UserError(name + ": physical triangles that are no face of a tetrahedron: element "
                          + list_numbers(stray)
                          + ". Take surfaces that bound no volume out of the Physical Surfaces, or "
                            "mesh surfaces and volumes together.");
        for (const auto &[id, triangles] : internal)
          if (of_boundary.count(id) > 0)
            warnings.push_back(fmt::format(
                "{}: the boundary {} has {} triangles between two tetrahedra, too: element {}. "
                "'boundary {}' selects the nodes of all its triangles.",
                name, id, triangles.size(), list_numbers(triangles), id));
      }

      std::vector<BoundaryFace>
      boundary_faces(const std::vector<std::array<unsigned int, 4>> &cells) const
      {
        std::vector<BoundaryFace> result;
        for (std::size_t i = 0; i < boundary.size(); ++i)
          result.push_back({ outward_nodes(boundary[i], cells[boundary[i].cell]), ids[i] });
        return result;
      }

      std::vector<BoundaryFace>
      further_faces(const std::vector<std::array<unsigned int, 4>> &cells) const
      {
        std::vector<BoundaryFace> result;
        for (const auto &[nodes, id, face] : further)
          result.push_back({ face < boundary.size()
                                 ? outward_nodes(boundary[face], cells[boundary[face].cell])
                                 : nodes,
                             id });
        return result;
      }

    private:
      /// Ascending nodes, boundary id, and index in `boundary`, or its size for a face between two cells.
      using FurtherFace = std::tuple<std::array<unsigned int, 3>, unsigned int, std::size_t>;

      const std::vector<CellFace>                     &faces;
      std::vector<CellFace>                            boundary;
      std::vector<unsigned int>                        ids;
      std::set<FurtherFace>                            further;
      std::set<unsigned int>                           of_boundary; ///< ids
      std::map<unsigned int, std::vector<std::size_t>> internal;    ///< numbers of triangles, by id
      std::vector<std::size_t>                         stray;
    };

    dealii::SubCellData
    boundary_data(const std::vector<BoundaryFace> &faces)
    {
      dealii::SubCellData data;
      for (const BoundaryFace &face : faces)
        if (face.boundary_id != 0) // deal.II's own default
        {
          dealii::CellData<2> triangle(3);
          std::copy(face.nodes.begin(), face.nodes.end(), triangle.vertices.begin());
          triangle.boundary_id = face.boundary_id;
          data.boundary_quads.push_back(triangle);
        }
      return data;
    }

    /// The whole mesh as a part.
    MeshPart
    whole_part(MeshArrays arrays)
    {
      const auto n_cells = static_cast<unsigned int>(arrays.material_ids.size());
      MeshPart   part;
      part.whole = { static_cast<unsigned int>(arrays.contents.nodes.size()),
                     n_cells,
                     box_diagonal(arrays.contents.nodes),
                     { arrays.material_ids.begin(), arrays.material_ids.end() },
                     std::move(arrays.pieces) };
      part.cells_in_file.resize(n_cells);
      std::iota(part.cells_in_file.begin(), part.cells_in_file.end(), 0u);
      part.arrays = std::move(arrays);
      return part;
    }

    std::unique_ptr<dealii::Triangulation<3>>
    make_triangulation(const MeshArrays &arrays)
    {
      const auto                      &cells = arrays.cells;
      std::vector<dealii::CellData<3>> cell_data(cells.size(), dealii::CellData<3>(4));
      for (std::size_t c = 0; c < cells.size(); ++c)
      {
        std::copy(cells[c].begin(), cells[c].end(), cell_data[c].vertices.begin());
        cell_data[c].material_id = arrays.material_ids[c];
      }
      auto result = std::make_unique<dealii::Triangulation<3>>();
      result->create_triangulation(arrays.contents.nodes, cell_data,
                                   boundary_data(arrays.boundary_faces));
      return result;
    }

    /// Check that deal.II's numbers are the file's, on which everything else relies: 9.5 has begun
    /// to remove unused vertices when reading.
    void
    check_numbering(const dealii::Triangulation<3> &triangulation, const MeshArrays &arrays)
    {
      bool same = triangulation.n_active_cells() == arrays.cells.size()
                  && triangulation.get_vertices() == arrays.contents.nodes;
      for (const auto &cell : triangulation.active_cell_iterators())
        for (const unsigned int v : cell->vertex_indices())
          same = same && cell->vertex_index(v) == arrays.cells[cell->active_cell_index()][v];
      AssertThrow(same, dealii::ExcMessage("deal.II numbers nodes or cells in another order."));
    }
  } // namespace

  Mesh::Mesh(const MeshParameters &parameters)
      : Mesh(load_mesh(parameters), parameters.name(), parameters.scale, parameters.kind)
  {
  }

  MeshArrays
  check_mesh(MshFile contents, const std::string &name, const double scale)
  {
    MeshArrays mesh;
    scale_nodes(contents, name, scale);
    if (!contents.note.empty())
      mesh.warnings.push_back(contents.note);

    Tetrahedra tetrahedra = extract_tetrahedra(contents, name);
    const auto swapped    = orient_tetrahedra(contents, name, tetrahedra);
    if (!swapped.empty())
      mesh.warnings.push_back(
          fmt::format("{}: {} tetrahedra of negative volume were re-oriented: element {}.", name,
                      swapped.size(), list_numbers(swapped)));
    check_orphan_nodes(contents, name, tetrahedra);
    const std::vector<CellFace> faces = sorted_faces(tetrahedra);
    check_faces(contents, name, tetrahedra, faces);
    check_overlaps(contents, name, tetrahedra, faces, swapped);
    mesh.pieces = find_pieces(contents, name, tetrahedra, faces);

    BoundaryIds boundary_ids(faces);
    for (const MshElement &element : contents.elements)
      if (element.type == MshElementType::triangle && element.physical != 0)
      {
        boundary_ids.add(element, element.physical);
        for (const int tag : further_groups_of(contents, element))
          boundary_ids.add(element, tag);
      }
    boundary_ids.report(name, mesh.warnings);

    mesh.contents        = std::move(contents);
    mesh.cells           = std::move(tetrahedra.nodes);
    mesh.material_ids    = std::move(tetrahedra.material_ids);
    mesh.element_numbers = std::move(tetrahedra.element_numbers);
    mesh.boundary_faces  = boundary_ids.boundary_faces(mesh.cells);
    mesh.further_faces   = boundary_ids.further_faces(mesh.cells);
    return mesh;
  }

  double
  box_diagonal(const std::vector<dealii::Point<3>> &nodes)
  {
    dealii::Point<3> lower = nodes.front();
    dealii::Point<3> upper = lower;
    for (const auto &node : nodes)
      for (unsigned int d = 0; d < 3; ++d)
      {
        lower[d] = std::min(lower[d], node[d]);
        upper[d] = std::max(upper[d], node[d]);
      }
    return lower.distance(upper);
  }

  Mesh::Mesh(MshFile            contents,
             const std::string &file_name,
             const double       scale,
             const MeshKind     kind)
      : Mesh(whole_part((kind == MeshKind::shell ? check_shell : check_mesh)(
                 std::move(contents), file_name, scale)),
             file_name,
             scale)
  {
  }

  Mesh::Mesh(MeshPart part, const std::string &file_name, const double scale)
      : arrays(std::move(part.arrays)), name(file_name), scale(scale),
        of_whole(std::move(part.whole)), shared(std::move(part.exchange)),
        with_others(shared == nullptr ? &Exchange::serial() : shared.get()),
        order(std::move(part.cells_in_file), of_whole.n_cells, *with_others),
        file(std::move(part.contents_of_whole))
  {
  }

  const dealii::Triangulation<3> &
  Mesh::get_triangulation() const
  {
    if (triangulation == nullptr)
    {
      triangulation = shared == nullptr
                          ? make_triangulation(arrays)
                          : make_distributed_triangulation(arrays, order.in_file(), *shared);
      check_numbering(*triangulation, arrays);
    }
    return *triangulation;
  }

  std::size_t
  Mesh::memory_consumption() const
  {
    const MshFile &contents = arrays.contents;
    std::size_t    bytes    = (triangulation == nullptr ? 0 : triangulation->memory_consumption())
                        + contents.nodes.capacity() * sizeof(contents.nodes[0])
                        + contents.node_numbers.capacity() * sizeof(contents.node_numbers[0])
                        + arrays.cells.capacity() * sizeof(arrays.cells[0])
                        + arrays.material_ids.capacity() * sizeof(arrays.material_ids[0])
                        + arrays.element_numbers.capacity() * sizeof(arrays.element_numbers[0])
                        + arrays.boundary_faces.capacity() * sizeof(arrays.boundary_faces[0]);
    for (const MshElement &element : contents.elements)
      bytes += sizeof(element) + element.nodes.capacity() * sizeof(element.nodes[0]);
    return bytes;
  }

  std::vector<std::size_t>
  whole_elements(const Mesh &mesh, const std::vector<unsigned int> &own_cells)
  {
    std::vector<std::size_t> pairs; // pairs of a cell's index in the file and its element number
    for (const unsigned int cell : own_cells)
    {
      pairs.push_back(mesh.cell_order().in_file()[cell]);
      pairs.push_back(mesh.element_number(cell));
    }
    pairs = mesh.exchange().collect(std::move(pairs));
    std::vector<std::pair<std::size_t, std::size_t>> by_place;
    for (std::size_t i = 0; i < pairs.size(); i += 2)
      by_place.emplace_back(pairs[i], pairs[i + 1]);
    std::sort(by_place.begin(), by_place.end());
    std::vector<std::size_t> elements;
    for (const auto &[place, element] : by_place)
      elements.push_back(element);
    return elements;
  }
} // namespace Exemplar
