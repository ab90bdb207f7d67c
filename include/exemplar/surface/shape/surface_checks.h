// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_checks_h
#define exemplar_surface_checks_h

#include <exemplar/surface/shape/triangle_surface.h>

namespace Exemplar
{
  /// A triangle surface and the faces of the file that its triangles come from, which messages
  /// number from 1.
  struct CheckedSurface
  {
    TriangleSurface           surface;
    std::vector<unsigned int> faces; ///< face of each triangle; empty: triangles are faces
  };

  /// A face or vertex of the file that is part of a fault.
  struct FaultyElement
  {
    std::string  fault; ///< a line of SurfaceFindings::faults
    bool         is_face;
    unsigned int index; ///< number in the file, from 0
  };

  /// Faults of a surface that should bound a body.
  struct SurfaceFindings
  {
    /// Faults that make the surface unfit to be filled with cells: a line each with kind, number
    /// and place.
    std::vector<std::string> faults;
    /// All faces of the faults, or their vertices where these tell more; some more than once.
    std::vector<FaultyElement> elements;
    /// Harmless findings, a line each: vertices that no face uses, or that coincide; shells side by side.
    std::vector<std::string> notes;
    /// The shell of each triangle (component connected through edges), numbered by first triangle.
    std::vector<unsigned int> shells;
    unsigned int              n_shells = 0;
  };

  /// Look for faces without area, holes, edges of more than two faces, vertices where several fans
  /// of faces meet, faces that are turned against their neighbours, shells that are inside out,
  /// and intersecting faces. Intersections are looked for where edges and vertices are as they should be; shells side by
  /// side bound pieces of a body, and those within others its materials and cavities.
  SurfaceFindings
  check_surface(const CheckedSurface &checked);

  /// Turn faces against which most of their shell is turned. Faces meet through edges of two.
  /// Returns the triangles that were turned.
  std::vector<unsigned int>
  turn_to_majority(TriangleSurface &surface);

  /// Turn shells that are inside out and within no other. Precondition: closed shells that do not
  /// intersect. Returns the number of shells turned.
  unsigned int
  turn_outermost_outwards(TriangleSurface &surface);

  /// Drop vertices that no triangle uses.
  void
  drop_unused_vertices(TriangleSurface &surface);
} // namespace Exemplar

#endif
