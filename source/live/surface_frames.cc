// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/surface_frames.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

namespace Exemplar::Live
{
  namespace
  {
    static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "as messages have it");

    constexpr double max_short = 32767.;

    template <typename Number>
    void
    append(std::string &bytes, const Number value)
    {
      bytes.append(reinterpret_cast<const char *>(&value), sizeof(value));
    }

    /// Least and greatest value of a coordinate.
    struct Range
    {
      double min = std::numeric_limits<double>::infinity(), max = -min;

      void
      add(const double x)
      {
        min = std::min(min, x);
        max = std::max(max, x);
      }

      double
      size() const
      {
        return max - min;
      }
    };

    void
    append_places(std::string       &bytes,
                  const BodySurface &surface,
                  const Vector      &positions,
                  const Range *const box)
    {
      for (const unsigned int node : surface.nodes)
        for (unsigned int c = 0; c < 3; ++c)
        {
          // viewers know the box in single precision
          const double min  = static_cast<float>(box[c].min),
                       size = static_cast<float>(box[c].size());
          const double part = size > 0. ? (positions[3 * node + c] - min) / size : 0.5;
          append(bytes, static_cast<std::int16_t>(std::lround(
                            std::clamp((2. * part - 1.) * max_short, -max_short, max_short))));
        }
    }

    /// The values that the ends of the colours stand for. A range that is too small is widened about its middle, but no
    /// further below 0 than the values are.
    Range
    range_of(const Colours &colours)
    {
      if (colours.values.empty())
        return { 0., 0. };
      Range range;
      for (const double value : colours.values)
        range.add(value);
      if (const double missing = colours.least_size - range.size(); missing > 0.)
      {
        const double below = std::min(0.5 * missing, std::max(range.min, 0.));
        range.min -= below;
        range.max += missing - below;
      }
      return range;
    }

    void
    append_colours(std::string &bytes, const std::vector<double> &colours, const Range &range)
    {
      for (const double colour : colours)
        append(bytes, static_cast<std::uint8_t>(std::lround(
                          range.size() > 0. ? 255. * (colour - range.min) / range.size() : 0.)));
    }
  } // namespace

  BodySurface::BodySurface(const Mesh &mesh)
  {
    constexpr unsigned int    none = -1;
    std::vector<unsigned int> vertex(mesh.n_nodes(), none);
    for (const auto &face : mesh.get_boundary_faces())
      for (const unsigned int node : face.nodes)
        vertex[node] = 0;
    for (unsigned int node = 0; node < vertex.size(); ++node)
      if (vertex[node] != none)
      {
        vertex[node] = nodes.size();
        nodes.push_back(node);
      }
    for (const auto &face : mesh.get_boundary_faces())
      triangles.push_back(
          { { vertex[face.nodes[0]], vertex[face.nodes[1]], vertex[face.nodes[2]] } });
  }

  BodySurface::BodySurface(const std::size_t                             n_vertices,
                           const std::vector<std::vector<unsigned int>> &polygons)
      : nodes(n_vertices)
  {
    std::iota(nodes.begin(), nodes.end(), 0U);
    for (const auto &polygon : polygons)
    {
      for (std::size_t k = 2; k < polygon.size(); ++k)
        triangles.push_back({ { polygon[0], polygon[k - 1], polygon[k] } });
      if (polygon.size() == 3)
        triangles.push_back({ { polygon[0], polygon[2], polygon[1] } });
    }
  }

  Bytes
  topology_message(const BodySurface &surface, const BinaryKind kind)
  {
    std::string bytes;
    append(bytes, static_cast<std::uint32_t>(kind));
    append(bytes, static_cast<std::uint32_t>(surface.nodes.size()));
    append(bytes, static_cast<std::uint32_t>(surface.triangles.size()));
    for (const auto &triangle : surface.triangles)
      for (const unsigned int vertex : triangle)
        append(bytes, static_cast<std::uint32_t>(vertex));
    return std::make_shared<const std::string>(std::move(bytes));
  }

  Bytes
  frame_message(const FrameHead   &head,
                const BodySurface &surface,
                const Vector      &positions,
                const Colours     &colours)
  {
    Range box[3];
    for (const unsigned int node : surface.nodes)
      for (unsigned int c = 0; c < 3; ++c)
        box[c].add(positions[3 * node + c]);
    const Range range = range_of(colours);
    std::string bytes;
    bytes.reserve(64 + 7 * surface.nodes.size());
    append(bytes, static_cast<std::uint32_t>(head.kind));
    append(bytes, head.number);
    append(bytes, head.step);
    append(bytes, head.pointer);
    append(bytes, head.time);
    for (const Range &along : box)
      append(bytes, static_cast<float>(along.min));
    for (const Range &along : box)
      append(bytes, static_cast<float>(along.size()));
    append(bytes, static_cast<std::uint32_t>(surface.nodes.size()));
    append(bytes, static_cast<std::uint32_t>(!colours.values.empty()));
    append(bytes, static_cast<float>(range.min));
    append(bytes, static_cast<float>(range.max));
    append_places(bytes, surface, positions, box);
    append_colours(bytes, colours.values, range);
    return std::make_shared<const std::string>(std::move(bytes));
  }

  double
  rounding_of_frame(const BodySurface &surface, const Vector &positions)
  {
    double largest = 0., farthest = 0.;
    for (unsigned int c = 0; c < 3; ++c)
    {
      Range along;
      for (const unsigned int node : surface.nodes)
        along.add(positions[3 * node + c]);
      largest  = std::max(largest, along.size());
      farthest = std::max({ farthest, std::abs(along.min), std::abs(along.max) });
    }
    // half of a quantization step, plus rounding of the box to single precision
    return largest / (4. * max_short) + 2. * farthest * std::numeric_limits<float>::epsilon();
  }

  std::vector<double>
  at_vertices(const std::vector<double> &of_cells, const Mesh &mesh, const BodySurface &surface)
  {
    std::vector<double> sums(mesh.n_nodes(), 0.), counts(mesh.n_nodes(), 0.), result;
    for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
      for (const unsigned int node : mesh.corners(cell))
      {
        sums[node] += of_cells[cell];
        counts[node] += 1.;
      }
    for (const unsigned int node : surface.nodes)
      result.push_back(sums[node] / counts[node]);
    return result;
  }
} // namespace Exemplar::Live
