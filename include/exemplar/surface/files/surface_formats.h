// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_formats_h
#define exemplar_surface_formats_h

#include <exemplar/surface/shape/surface_mesh.h>

#include <map>
#include <string_view>

namespace Exemplar
{
  class SurfaceScanner;

  /// Wavefront .obj: v and f with all forms of indices (i, i/j, i//k, i/j/k, negative ones, too).
  /// The groups are those of g; without any, those of usemtl; without any, those of o.
  SurfaceMesh
  read_obj(SurfaceScanner &in);

  /// Stanford .ply, ASCII or binary of either byte order. The groups are the numbers of the
  /// faces' first property that is called like a label.
  SurfaceMesh
  read_ply(SurfaceScanner &in);

  /// A property of the vertices of a .ply.
  struct PlyAttribute
  {
    std::vector<SurfaceMesh::Vertex> vertices;
    std::vector<double>              values; ///< one a vertex; colours of one byte over 255
  };

  /// Throws UserError if the vertices have no scalar property of this name, naming those they have.
  PlyAttribute
  read_ply_attribute(SurfaceScanner &in, const std::string &name);

  /// .stl, ASCII (a group each solid) or binary. Corners of the same coordinates are one vertex.
  SurfaceMesh
  read_stl(SurfaceScanner &in);

  /// Adds faces with the names of their groups to a surface; a group's index is the number of
  /// names that came before it.
  class GroupedFaces
  {
  public:
    explicit GroupedFaces(SurfaceMesh &mesh) : surface(mesh) {}

    void
    add(std::vector<unsigned int> vertices, const std::string &group);

    /// Groups that say nothing, because no face has a name, are left out.
    void
    finish();

  private:
    SurfaceMesh                        &surface;
    std::map<std::string, unsigned int> index_of;
    unsigned int                        last_group = 0;
  };

  /// Throw UserError, by way of the scanner, for a vertex number that a surface cannot have.
  void
  require_few(const SurfaceScanner &in, std::size_t n, const std::string &what);
} // namespace Exemplar

#endif
