// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_write_obj_h
#define exemplar_write_obj_h

#include <exemplar/surface/shape/surface_mesh.h>

namespace Exemplar
{
  /// Write a surface as .obj: vertices and faces in their order, coordinates with as many digits
  /// as give the same doubles back, groups as g. The file appears whole or not at all. Throws
  /// std::runtime_error if it cannot be written.
  void
  write_obj(const SurfaceMesh &surface, const std::filesystem::path &file);

  /// The two parts of an .obj, to be written one after the other: a line for each vertex; then
  /// texture points, and faces with the statements of the file that they were read from, or, if it
  /// had none, with their groups as g. Normals are left out, as they are those of another pose.
  std::string
  obj_vertices(const std::vector<SurfaceMesh::Vertex> &vertices);
  std::string
  obj_faces(const SurfaceMesh &surface);
} // namespace Exemplar

#endif
