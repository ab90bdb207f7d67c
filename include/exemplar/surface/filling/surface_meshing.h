// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_meshing_h
#define exemplar_surface_meshing_h

#include <exemplar/mesh/msh_file.h>
#include <exemplar/surface/filling/tetrahedra_inside.h>

#include <functional>
#include <utility>

namespace Exemplar
{
  /// What the making of a mesh has come to, in this order.
  enum class MeshingStage : unsigned short
  {
    checking, ///< the surface is read, checked, and mended
    thinning, ///< dense triangles become as fine as cells can follow
    filling,  ///< edges become as long as the cells want, and it is filled; several times
    measuring ///< cells are brought back from where they were made, and distances taken
  };

  /// What to make of a surface.
  struct SurfaceMeshingOptions
  {
    std::filesystem::path surface;
    unsigned int          n_cells = 0; ///< wanted
    bool                  repair  = false;
    /// Poses of the surface, in which sheets that cross at rest may be apart.
    std::vector<std::filesystem::path> poses = {};
    std::filesystem::path materials          = {}; ///< a table, see read_material_seeds(); or empty
    /// What the user calls cells and repair, for messages.
    std::string cells_option = "--cells", repair_option = "--repair";
    /// Is called at the beginning of each stage, and again for each attempt at it.
    std::function<void(MeshingStage)> tell = [](MeshingStage) {};
  };

  /// How a mesh became.
  struct MeshingReport
  {
    std::vector<std::pair<std::string, std::string>> table; ///< (what, how much)
    std::vector<std::string>                         notes; ///< lines for the user
  };

  /// A mesh inside a surface, and how it became.
  struct MeshedSurface
  {
    MshFile       mesh; ///< groups of faces are its physical surfaces, shells its physical volumes
    MeshingReport report;
  };

  /// Another place of a surface in which it is filled, and the way of its cells back to rest.
  struct FillingPlace
  {
    std::vector<SurfaceMesh::Vertex>       vertices;
    std::function<void(TetrahedralMesh &)> carry_back; ///< empty: the place is that at rest
    std::vector<std::string>               notes;      ///< what the user should know of both
  };

  /// Read a surface, check it (and mend it, if that is wished), make its edges as long as the number
  /// of cells wants, fill it with tetrahedra and remove flat ones. Places are those of the file, in
  /// its unit and axes. Throws UserError for a surface that is no boundary of a body, with what is
  /// wrong and where; SolverFailure if it cannot be filled.
  MeshedSurface
  mesh_surface(const SurfaceMeshingOptions &options);

  /// The same of a surface that has been read, filled at `place`. Distances and angles are those of
  /// the mesh at rest.
  MeshedSurface
  mesh_surface_at(const SurfaceMesh           &rest,
                  const FillingPlace          &place,
                  const SurfaceMeshingOptions &options);
} // namespace Exemplar

#endif
