// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_selector_h
#define exemplar_surface_selector_h

#include <exemplar/surface/files/painted_map.h>
#include <exemplar/surface/skin/surface_attachment.h>

#include <string>
#include <vector>

namespace Exemplar
{
  class Mesh;

  /// Selections of nodes and values at cells by the surface around a mesh.
  class SurfaceSelector
  {
  public:
    /// `surface` is around the cells, or a shell's own. It is in the unit of its file, of which `scale` makes metres. Keeps references to
    /// mesh and surface. Throws UserError if the mesh is not one of the surface's inside.
    SurfaceSelector(const Mesh        &mesh,
                    const SurfaceMesh &surface,
                    double             scale,
                    const std::string &surface_name);

    /// The boundary nodes of a selection by the surface, ascending:
    /// "vertex N..." the nearest to each of some vertices, numbered from 1 as in the file;
    /// "vertex N... within D" those whose nearest point of the surface is no farther from the
    /// nearest of the vertices, along the surface, than D [m];
    /// "group NAME" those whose nearest point lies on a face of a group, or on its border;
    /// "map NAME [above X | below X]" those at whose nearest point the value of a map of `maps`,
    /// linear over each triangle, is greater than X (or less); "above 0.5" if that is left out.
    /// Throws UserError, calling it `key`, if it is misspelt or selects nothing.
    std::vector<unsigned int>
    select(const std::string &text, const std::string &key, const NamedMaps &maps) const;

    /// Values at the cells: the value at the point of the surface nearest to each cell's centre,
    /// linear over each triangle between `values` at the vertices; at the centre of each triangle of a shell.
    std::vector<double>
    at_cells(const std::vector<double> &values) const;

    /// The attachment of some nodes of the mesh to the surface.
    SurfaceAttachment
    hang(const std::vector<unsigned int> &nodes) const;

  private:
    using Nodes = std::vector<unsigned int>;

    Nodes
    nearest_to(const std::vector<unsigned int> &vertices) const;
    Nodes
    within(const std::vector<unsigned int> &vertices,
           double                           distance,
           const std::string               &choice) const;
    Nodes
    of_vertices(const std::string &words, const std::string &choice) const;
    Nodes
    of_group(const std::string &group, const std::string &choice) const;
    Nodes
    of_map(const std::string &words, const std::string &choice, const NamedMaps &maps) const;

    const Mesh             &mesh;
    const SurfaceMesh      &surface;
    const std::string       name;
    const SurfaceAttachment boundary;

    mutable std::vector<SurfacePoint>
        centres; ///< points nearest to the cells' centres; empty until needed
  };
} // namespace Exemplar

#endif
