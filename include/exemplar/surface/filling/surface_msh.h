// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_msh_h
#define exemplar_surface_msh_h

#include <exemplar/mesh/msh_file.h>
#include <exemplar/surface/filling/material_seeds.h>

namespace Exemplar
{
  /// A name for each region: that of the group of the shell around it, if it has one and no other
  /// region has the same; else "shell N", or "body" if there is no other region.
  std::vector<std::string>
  names_of_regions(const TetrahedralMesh &mesh, const std::vector<std::string> &group_names);

  /// Regions as materials: names that are all whole numbers are the ids, others are numbered from
  /// 1.
  Materials
  materials_by_regions(const TetrahedralMesh &mesh, const std::vector<std::string> &region_names);

  /// The mesh as a .msh file: groups of the outer triangles become physical surfaces, named by the
  /// rule of names_of_regions(), and materials become physical volumes.
  MshFile
  make_surface_msh(const TetrahedralMesh          &mesh,
                   const std::vector<std::string> &group_names,
                   const Materials                &materials);
} // namespace Exemplar

#endif
