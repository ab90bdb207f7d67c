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
  /// Bytes of a binary message, which several viewers get.
  using Bytes = std::shared_ptr<const std::string>;

  /// The kind of a binary message: its first number.
  enum class BinaryKind : std::uint32_t
  {
    topology = 0,
    frame    = 1,
    pose     = 2 ///< an example, as a frame whose number is that of the example
  };

  /// What is seen of a body: its boundary, with vertices of its own numbering.
  struct BodySurface
  {
    BodySurface() = default;

    explicit BodySurface(const Mesh &mesh);

    std::vector<unsigned int>                nodes;     ///< of the mesh, of each vertex, ascending
    std::vector<std::array<unsigned int, 3>> triangles; ///< of vertices, outwards
  };

  /// Kind, numbers of vertices and triangles, and the three vertices of each triangle, as 32 bits each.
  Bytes
  topology_message(const BodySurface &surface);

  /// What stands in a frame beside the places.
  struct FrameHead
  {
    BinaryKind    kind    = BinaryKind::frame;
    std::uint32_t number  = 0;
    std::uint32_t step    = 0;
    std::uint32_t pointer = 0;  ///< the newest that the step knew
    double        time    = 0.; ///< [s]
  };

  /// A frame: places as 16-bit integers in the box of the frame, so that each coordinate is known to
  /// 1/131068 of the box' edge along it. `colours` are values at the vertices, sent as one byte each;
  /// empty: none. Bytes in the order of doc/live.md.
  Bytes
  frame_message(const FrameHead           &head,
                const BodySurface         &surface,
                const Vector              &positions,
                const std::vector<double> &colours = {});

  /// How far a coordinate of such a frame is from what it stands for, at most [m].
  double
  rounding_of_frame(const BodySurface &surface, const Vector &positions);

  /// The mean at the surface's vertices of what the cells have.
  std::vector<double>
  at_vertices(const std::vector<double> &of_cells, const Mesh &mesh, const BodySurface &surface);
} // namespace Exemplar::Live

#endif
