// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/obstacles/obstacle_shape.h>
#include <exemplar/surface/shape/surface_edges.h>
#include <exemplar/surface/shape/triangle_surface.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Exemplar
{
  const std::string obstacle_forms
      = "plane x y z nx ny nz | sphere x y z r | capsule x0 y0 z0 x1 y1 z1 r | box x0 y0 z0 x1 y1 "
        "z1 | inside box x0 y0 z0 x1 y1 z1 | surface FILE";

  namespace
  {
    SpaceVector3
    vector_at(const std::vector<double> &numbers, const std::size_t first)
    {
      SpaceVector3 result;
      for (unsigned int c = 0; c < 3; ++c)
        result[c] = numbers[first + c];
      return result;
    }

    ObstacleShape
    plane(const std::vector<double> &n)
    {
      ObstacleShape      shape;
      const SpaceVector3 normal = vector_at(n, 3);
      shape.middle              = vector_at(n, 0);
      shape.half_spaces         = { { normal / normal.norm(), 0. } };
      return shape;
    }

    ObstacleShape
    sphere(const std::vector<double> &n)
    {
      ObstacleShape shape;
      shape.middle   = vector_at(n, 0);
      shape.vertices = { SpaceVector3() };
      shape.points   = { 0 };
      shape.radius   = n[3];
      return shape;
    }

    ObstacleShape
    capsule(const std::vector<double> &n)
    {
      ObstacleShape      shape;
      const SpaceVector3 begin = vector_at(n, 0), end = vector_at(n, 3);
      shape.middle   = 0.5 * (begin + end);
      shape.vertices = { begin - shape.middle, end - shape.middle };
      shape.points   = { 0, 1 };
      shape.edges    = { { { 0, 1 } } };
      shape.radius   = n[6];
      return shape;
    }

    /// The corners of a box of these half sizes: bit c of the index says the side along axis c.
    std::vector<SpaceVector3>
    corners(const SpaceVector3 &half_sizes)
    {
      std::vector<SpaceVector3> result;
      for (unsigned int i = 0; i < 8; ++i)
      {
        SpaceVector3 corner;
        for (unsigned int c = 0; c < 3; ++c)
          corner[c] = (i >> c & 1U) != 0 ? half_sizes[c] : -half_sizes[c];
        result.push_back(corner);
      }
      return result;
    }

    ObstacleShape
    box(const std::vector<double> &n)
    {
      ObstacleShape      shape;
      const SpaceVector3 low = vector_at(n, 0), high = vector_at(n, 3);
      shape.middle     = 0.5 * (low + high);
      shape.half_sizes = 0.5 * (high - low);
      shape.vertices   = corners(*shape.half_sizes);
      for (unsigned int i = 0; i < 8; ++i)
      {
        shape.points.push_back(i);
        for (unsigned int c = 0; c < 3; ++c)
          if ((i >> c & 1U) == 0)
            shape.edges.push_back({ { i, i | 1U << c } });
      }
      return shape;
    }

    ObstacleShape
    inside_box(const std::vector<double> &n)
    {
      ObstacleShape      shape;
      const SpaceVector3 low = vector_at(n, 0), high = vector_at(n, 3);
      shape.middle = 0.5 * (low + high);
      shape.bounds = true;
      for (unsigned int c = 0; c < 3; ++c)
        for (const double sign : { 1., -1. })
        {
          SpaceVector3 normal;
          normal[c] = sign;
          shape.half_spaces.push_back({ normal, -0.5 * (high[c] - low[c]) });
        }
      return shape;
    }

    /// A form: its words, how many numbers follow, and what makes a shape of them.
    struct Form
    {
      std::string words;
      std::size_t n_numbers;
      ObstacleShape (*make)(const std::vector<double> &);
    };

    const std::vector<Form> &
    forms()
    {
      static const std::vector<Form> all = { { "plane", 6, plane },
                                             { "sphere", 4, sphere },
                                             { "capsule", 7, capsule },
                                             { "inside box", 6, inside_box },
                                             { "box", 6, box } };
      return all;
    }

    /// What is wrong with the numbers of a form; empty: nothing.
    std::string
    fault_of(const std::string &form, const std::vector<double> &n)
    {
      if (std::any_of(n.begin(), n.end(), [](const double x) { return !std::isfinite(x); }))
        return "its numbers must be finite";
      if (form == "plane" && vector_at(n, 3).norm() == 0.)
        return "its normal has no length. Give the direction in which the body is, such as 0 0 1";
      if ((form == "sphere" || form == "capsule") && !(n.back() > 0.))
        return "its radius must be positive";
      if (form == "box" || form == "inside box")
        for (unsigned int c = 0; c < 3; ++c)
          if (!(n[c] < n[c + 3]))
            return fmt::format("its second corner must be greater than the first one in {}",
                               "xyz"[c]);
      return "";
    }
  } // namespace

  ObstacleShape
  parse_shape(const std::string &text, const std::string &key)
  {
    for (const auto &[words, n_numbers, make] : forms())
    {
      if (text.compare(0, words.size() + 1, words + " ") != 0)
        continue;
      std::istringstream  in(text.substr(words.size()));
      std::vector<double> numbers;
      for (double number; in >> number;)
        numbers.push_back(number);
      if (!in.eof() || numbers.size() != n_numbers)
        throw UserError(fmt::format("{} = '{}' is not allowed: '{}' takes {} numbers, separated by "
                                    "blanks. Allowed: {}.",
                                    key, text, words, n_numbers, obstacle_forms));
      if (const std::string fault = fault_of(words, numbers); !fault.empty())
        throw UserError(key + " = '" + text + "' is not allowed: " + fault + ".");
      return make(numbers);
    }
    throw UserError(key + " = '" + text + "' is not allowed. Allowed: " + obstacle_forms + ".");
  }

  std::string
  file_of_shape(const std::string &text)
  {
    const std::string word = "surface ";
    if (text.compare(0, word.size(), word) != 0)
      return "";
    const std::size_t first = text.find_first_not_of(' ', word.size());
    return first == std::string::npos ? "" : text.substr(first);
  }

  namespace
  {
    SpaceVector3
    vertex_of(const TriangleSurface &surface, const TriangleSide &side, const unsigned int ahead)
    {
      const auto  &triangle = surface.triangles[side.triangle];
      SpaceVector3 x;
      for (unsigned int c = 0; c < 3; ++c)
        x[c] = surface.vertices[triangle[(side.corner + ahead) % 3]][c];
      return x;
    }

    /// Whether the triangles at both sides of an edge lie in one plane, but for rounding, and not one on the other.
    bool
    are_in_one_plane(const TriangleSurface &surface,
                     const TriangleSide    &side,
                     const TriangleSide    &other)
    {
      constexpr double   rounding = 1e-14;
      const SpaceVector3 a = vertex_of(surface, side, 0), edge = vertex_of(surface, side, 1) - a,
                         apex = vertex_of(surface, side, 2), beyond = vertex_of(surface, other, 2);
      const SpaceVector3 normal       = dealii::cross_product_3d(edge, apex - a),
                         other_normal = dealii::cross_product_3d(beyond - a, edge);
      const double size   = a.norm() + edge.norm() + (apex - a).norm() + (beyond - a).norm();
      const double height = std::abs(normal * (beyond - a));
      return height <= rounding * size * normal.norm() && normal * other_normal > 0.;
    }
  } // namespace

  ObstacleShape
  shape_of(const TriangleSurface &surface, const bool deforms)
  {
    ObstacleShape    shape;
    std::vector<int> number(surface.vertices.size(), -1);
    SpaceVector3     low, high;
    for (const auto &triangle : surface.triangles)
    {
      for (const unsigned int v : triangle)
        if (number[v] < 0)
        {
          number[v] = static_cast<int>(shape.vertices.size());
          SpaceVector3 x;
          for (unsigned int c = 0; c < 3; ++c)
            x[c] = surface.vertices[v][c];
          for (unsigned int c = 0; c < 3; ++c)
          {
            low[c]  = shape.vertices.empty() ? x[c] : std::min(low[c], x[c]);
            high[c] = shape.vertices.empty() ? x[c] : std::max(high[c], x[c]);
          }
          shape.vertices.push_back(x);
        }
      std::array<unsigned int, 3> corner{};
      for (unsigned int k = 0; k < 3; ++k)
        corner[k] = static_cast<unsigned int>(number[triangle[k]]);
      shape.triangles.push_back(corner);
    }
    UnionFind                       parts(surface.triangles.size());
    const std::vector<TriangleSide> sides = sorted_sides(surface);
    if (!deforms)
      for_each_edge(sides,
                    [&](const TriangleSide *first, const TriangleSide *last)
                    {
                      if (last - first == 2 && are_in_one_plane(surface, first[0], first[1]))
                        parts.join(first[0].triangle, first[1].triangle);
                    });
    for (unsigned int t = 0; t < surface.triangles.size(); ++t)
      shape.flat_parts.push_back(parts.root(t));
    std::vector<char> has_edge(shape.vertices.size(), 0);
    for_each_edge(sides,
                  [&](const TriangleSide *first, const TriangleSide *last)
                  {
                    const bool is_of_two = last - first == 2;
                    shape.is_closed      = shape.is_closed && is_of_two;
                    if (is_of_two
                        && shape.flat_parts[first[0].triangle]
                               == shape.flat_parts[first[1].triangle])
                      return;
                    std::array<unsigned int, 2> edge{};
                    for (unsigned int k = 0; k < 2; ++k)
                    {
                      edge[k]           = static_cast<unsigned int>(number[first->vertices[k]]);
                      has_edge[edge[k]] = 1;
                    }
                    shape.edges.push_back(edge);
                  });
    for (unsigned int v = 0; v < shape.vertices.size(); ++v)
      if (has_edge[v] != 0)
        shape.points.push_back(v);
    shape.middle = 0.5 * (low + high);
    for (SpaceVector3 &x : shape.vertices)
      x -= shape.middle;
    return shape;
  }

  void
  ObstacleShape::set_back(const double by)
  {
    for (HalfSpace &half_space : half_spaces)
      half_space.offset -= by;
    if (half_sizes)
    {
      for (unsigned int c = 0; c < 3; ++c)
        (*half_sizes)[c] = std::max((*half_sizes)[c] - by, 0.);
      vertices = corners(*half_sizes);
    }
    else if (!is_surface())
      radius = std::max(radius - by, 0.);
  }
} // namespace Exemplar
