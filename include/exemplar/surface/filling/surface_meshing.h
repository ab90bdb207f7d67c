// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_meshing_h
#define exemplar_surface_meshing_h

#include <exemplar/mesh/msh_file.h>
#include <exemplar/surface/filling/surface_remeshing.h>
#include <exemplar/surface/filling/tetrahedra_inside.h>

#include <functional>
#include <utility>

namespace Exemplar
{
  /// Stages of mesh generation, in this order.
  enum class MeshingStage : unsigned short
  {
    checking, ///< the surface is read, checked, and mended
    thinning, ///< triangles much finer than the cells are coarsened
    filling,  ///< the surface is remeshed to the wanted edge length and filled; several times
    measuring ///< cells are carried back to the rest place, distances are measured
  };

  /// Options of mesh_surface().
  struct SurfaceMeshingOptions
  {
    std::filesystem::path surface;
    unsigned int          n_cells = 0; ///< number of cells that is wanted
    bool                  repair  = false;
    /// Poses of the surface, in which sheets that cross at rest may be apart.
    std::vector<std::filesystem::path> poses = {};
    std::filesystem::path materials          = {}; ///< a table, see read_material_seeds(); or empty
    /// Names of the options for the number of cells and for repair, for messages.
    std::string cells_option = "--cells", repair_option = "--repair";
    /// Called at the beginning of each stage, and again for each attempt at it.
    std::function<void(MeshingStage)> tell = [](MeshingStage) {};
  };

  /// Report on the generation of a mesh.
  struct MeshingReport
  {
    std::vector<std::pair<std::string, std::string>> table; ///< (what, how much)
    std::vector<std::string>                         notes; ///< lines for the user
  };

  /// A mesh inside a surface, and the report on its generation.
  struct MeshedSurface
  {
    MshFile       mesh; ///< groups of faces are its physical surfaces, shells its physical volumes
    MeshingReport report;
  };

  /// Vertex positions in which a surface is filled, and the map of its cells back to the rest
  /// place.
  struct FillingPlace
  {
    std::vector<SurfaceMesh::Vertex>       vertices;
    std::function<void(TetrahedralMesh &)> carry_back; ///< empty: `vertices` are at rest
    std::vector<std::string>               notes;      ///< lines for the user
    std::vector<OpenGap>                   gaps;       ///< gaps that are to stay open
  };

  /// Estimated edge length of a body with so many cells: in gmsh's meshes a cell has about a tenth
  /// of the volume of the cube over its edge.
  double
  edge_length_of(const TriangleSurface &surface, double n_cells);

  /// Read a surface, check it (and mend it, if that is wished), make its edges as long as the
  /// number of cells wants, fill it with tetrahedra and remove flat ones. Places are those of the
  /// file, in its unit and axes. Throws UserError for a surface that is no boundary of a body, with
  /// what is wrong and where; SolverFailure if it cannot be filled.
  MeshedSurface
  mesh_surface(const SurfaceMeshingOptions &options);

  /// mesh_surface() for a surface that has been read, filled with its vertices at `place`.
  /// Distances and angles are those of the mesh at rest.
  MeshedSurface
  mesh_surface_at(const SurfaceMesh           &rest,
                  const FillingPlace          &place,
                  const SurfaceMeshingOptions &options);
} // namespace Exemplar

#endif
