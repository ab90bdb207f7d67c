// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_meshing_report_h
#define exemplar_meshing_report_h

#include <exemplar/surface/filling/body_surface.h>
#include <exemplar/surface/filling/cell_angles.h>
#include <exemplar/surface/filling/surface_meshing.h>
#include <exemplar/surface/shape/surface_geometry.h>

namespace Exemplar
{
  /// Quality of a mesh: angles of its cells and distances to the surface.
  struct Judgement
  {
    CellAngles      angles;
    SurfaceDistance surface_to_mesh;
    SurfaceDistance mesh_to_surface;
    double          lost = 0.; ///< largest distance of the repaired surface to the mesh
  };

  /// A mesh and its quality.
  struct JudgedMesh
  {
    TetrahedralMesh mesh;
    Judgement       judgement;
  };

  /// The report on a mesh for the user.
  MeshingReport
  make_report(const FillingPlace          &place,
              const BodySurface           &body,
              const JudgedMesh            &judged,
              std::size_t                  n_materials,
              const SurfaceMeshingOptions &options);
} // namespace Exemplar

#endif
