// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_msh_h
#define exemplar_surface_msh_h

#include <exemplar/mesh/msh_file.h>
#include <exemplar/surface/filling/tetrahedra_inside.h>

#include <map>

namespace Exemplar
{
  /// A point of a body, and the material of the cells around it.
  struct MaterialSeed
  {
    SurfaceMesh::Vertex place;
    unsigned int        id; ///< material id, from 1
    std::string         name;
    std::size_t         line; ///< line of the file
  };

  /// The rows of a table in CSV with the header x,y,z,id or x,y,z,id,name; blank lines and lines
  /// that begin with # are passed over. Throws UserError with the line.
  std::vector<MaterialSeed>
  read_material_seeds(const std::filesystem::path &file);

  /// Material ids of the cells, and their names.
  struct Materials
  {
    std::vector<unsigned int>           of_cell;
    std::map<unsigned int, std::string> names; ///< empty: without a name
  };

  /// Each cell takes the id of the nearest seed to its centre among those that lie in its region;
  /// regions without a seed take the smallest ids that are left, and the names of `region_names`.
  /// Throws UserError for a seed that lies in no cell, or whose id no cell takes.
  Materials
  materials_by_seeds(const TetrahedralMesh           &mesh,
                     const std::vector<MaterialSeed> &seeds,
                     const std::vector<std::string>  &region_names,
                     const std::filesystem::path     &file);

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
