// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_meshing_report_h
#define exemplar_meshing_report_h

#include <exemplar/surface/filling/body_surface.h>
#include <exemplar/surface/filling/cell_angles.h>
#include <exemplar/surface/filling/surface_meshing.h>
#include <exemplar/surface/shape/surface_geometry.h>

namespace Exemplar
{
  /// What a mesh is judged by.
  struct Judgement
  {
    CellAngles      angles;
    SurfaceDistance surface_to_mesh;
    SurfaceDistance mesh_to_surface;
    double          lost = 0.; ///< the farthest that a point of the mended surface is off
  };

  /// A mesh with what it is judged by.
  struct JudgedMesh
  {
    TetrahedralMesh mesh;
    Judgement       judgement;
  };

  /// What the user is told of a mesh.
  MeshingReport
  make_report(const FillingPlace          &place,
              const BodySurface           &body,
              const JudgedMesh            &judged,
              std::size_t                  n_materials,
              const SurfaceMeshingOptions &options);
} // namespace Exemplar

#endif
