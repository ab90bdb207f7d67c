// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_surface_frames_h
#define exemplar_live_surface_frames_h

#include <exemplar/exemplar.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace Exemplar::Live
{
  /// Bytes of a binary message, shared by viewers.
  using Bytes = std::shared_ptr<const std::string>;

  /// The kind of a binary message: its first number.
  enum class BinaryKind : std::uint32_t
  {
    topology              = 0,
    frame                 = 1,
    pose                  = 2, ///< an example pose, as a frame with its number
    topology_of_obstacles = 3,
    obstacles             = 4, ///< where they are, as a frame; alone, or at the end of the body's
    inner_nodes = 5 ///< places of further nodes, at the end of a frame or pose; see SkinFrames
  };

  /// The boundary of a body, with its own numbering of vertices.
  struct BodySurface
  {
    BodySurface() = default;

    explicit BodySurface(const Mesh &mesh);

    /// Of polygons, as pictures of obstacles have them. What is a triangle already, as of an open
    /// surface, is seen from both sides.
    BodySurface(std::size_t n_vertices, const std::vector<std::vector<unsigned int>> &polygons);

    std::vector<unsigned int>                nodes;     ///< mesh node of each vertex, ascending
    std::vector<std::array<unsigned int, 3>> triangles; ///< counterclockwise from outside
  };

  /// The topology message: kind, numbers of vertices and triangles, and the three vertices of each
  /// triangle, as 32-bit integers.
  Bytes
  topology_message(const BodySurface &surface, BinaryKind kind = BinaryKind::topology);

  /// The head of a frame.
  struct FrameHead
  {
    BinaryKind    kind    = BinaryKind::frame;
    std::uint32_t number  = 0;
    std::uint32_t step    = 0;
    std::uint32_t pointer = 0;  ///< newest pointer sequence known to the step
    double        time    = 0.; ///< [s]
  };

  /// Values at the vertices that are shown as colours; empty: none.
  struct Colours
  {
    std::vector<double> values     = {};
    double              least_size = 0.; ///< of the interval of values that all colours span
  };

  /// A frame: places as 16-bit integers in the box of the frame, so that each coordinate is known
  /// to 1/131068 of the box' edge along it. Colours are sent as one byte
  /// each. Bytes in the order of doc/live.md.
  Bytes
  frame_message(const FrameHead   &head,
                const BodySurface &surface,
                const Vector      &positions,
                const Colours     &colours = {});

  /// Largest error of a coordinate in such a frame [m].
  double
  rounding_of_frame(const BodySurface &surface, const Vector &positions);

  /// Values at the surface's vertices: means of the values of adjacent cells.
  std::vector<double>
  at_vertices(const std::vector<double> &of_cells, const Mesh &mesh, const BodySurface &surface);
} // namespace Exemplar::Live

#endif
