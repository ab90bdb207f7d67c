// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_skin_frames_h
#define exemplar_live_skin_frames_h

#include <exemplar/live/surface_frames.h>

#include <string>
#include <vector>

namespace Exemplar::Live
{
  /// What is drawn instead of the boundary of a body that was made of an artist's surface: that surface and those that
  /// it carries (Mesh/Carry). Vertices are linear in the places of nodes, so viewers get their coefficients once and in
  /// each frame the nodes alone.
  class SkinFrames
  {
  public:
    /// `boundary` is the surface whose nodes frames have anyway. Throws UserError for a surface that cannot be read or
    /// is not that of the mesh.
    SkinFrames(const Problem &problem, const BodySurface &boundary);

    /// The surfaces in the order of doc/live.md; empty: the boundary is drawn.
    const std::string &
    topology() const
    {
      return bytes_of_topology;
    }

    /// A surface that is drawn: its vertices are those of its file, in that order.
    struct Surface
    {
      std::string name; ///< empty: that of the body
      std::size_t n_vertices;
    };

    /// Those of topology(), in its order.
    const std::vector<Surface> &
    get_surfaces() const
    {
      return surfaces;
    }

    /// A frame, and the places of the further nodes that the surfaces hang on.
    Bytes
    beside(const Bytes &frame, const Vector &positions) const;

  private:
    std::string          bytes_of_topology;
    std::vector<Surface> surfaces;
    BodySurface          inner; ///< nodes alone
  };
} // namespace Exemplar::Live

#endif
