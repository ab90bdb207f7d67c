// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/mesh/rigid_motion.h>
#include <exemplar/surface/shape/surface_poses.h>
#include <exemplar/surface/shape/triangle_surface.h>
#include <exemplar/surface/shape/vectors.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// Ratio of sizes: smaller for any pose of a body, greater between units.
    constexpr double max_ratio = 8.;

    /// A pose is taken for a mirror image if it fits one this many times better than it fits the
    /// surface at rest.
    constexpr double mirror_ratio = 4.;

    const char *const order_remedy
        = " A pose needs the vertices of the surface at rest, in its order: export both from the "
          "same model, without sorting, welding or splitting vertices, and without modifiers that "
          "make new ones.";

    std::string
    count(const std::size_t n, const std::string &noun)
    {
      return fmt::format("{} {}", n, n == 1 ? noun : noun == "vertex" ? "vertices" : noun + "s");
    }

    std::string
    corners(const std::vector<unsigned int> &face)
    {
      std::string text;
      for (const unsigned int vertex : face)
        text += fmt::format("{}{}", text.empty() ? "" : " ", vertex + 1);
      return text;
    }

    double
    total_area(const TriangleSurface &surface)
    {
      double sum = 0.;
      for (std::size_t t = 0; t < surface.triangles.size(); ++t)
        sum += area_of(surface, t);
      return sum;
    }

    std::vector<dealii::Point<3>>
    points_of(const TriangleSurface &surface)
    {
      std::vector<dealii::Point<3>> points;
      for (const auto &x : surface.vertices)
        points.emplace_back(x[0], x[1], x[2]);
      return points;
    }

    /// Sum of squared distances after the best rigid motion of points to targets.
    double
    misfit(const std::vector<dealii::Point<3>> &points,
           const std::vector<dealii::Point<3>> &targets)
    {
      const RigidMotion motion = best_rigid_motion(points, targets);
      double            sum    = 0.;
      for (std::size_t i = 0; i < points.size(); ++i)
        sum += motion(points[i]).distance_square(targets[i]);
      return sum;
    }

    /// The root of the mean squared distance from the middle.
    double
    spread(const std::vector<dealii::Point<3>> &points)
    {
      const dealii::Point<3> middle = centroid(points);
      double                 sum    = 0.;
      for (const auto &point : points)
        sum += point.distance_square(middle);
      return std::sqrt(sum / static_cast<double>(points.size()));
    }

    /// Median ratio of the lengths of sides in the pose and at rest.
    double
    median_stretch(const TriangleSurface &rest, const TriangleSurface &pose)
    {
      std::vector<double> ratios;
      for (const auto &t : rest.triangles)
        for (unsigned int k = 0; k < 3; ++k)
        {
          const auto length = [&](const TriangleSurface &s)
          { return norm(minus(s.vertices[t[(k + 1) % 3]], s.vertices[t[k]])); };
          if (const double at_rest = length(rest); at_rest > 0.)
            ratios.push_back(length(pose) / at_rest);
        }
      if (ratios.empty())
        return 1.;
      const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
      std::nth_element(ratios.begin(), middle, ratios.end());
      return *middle;
    }

    /// Refuses a surface of the same size whose faces reach across it: its vertices are in another
    /// order.
    void
    check_vertex_order(const TriangleSurface &rest,
                       const TriangleSurface &pose,
                       const std::string     &prefix)
    {
      constexpr double great_stretch = 3., max_growth = 1.5;
      const double     growth  = spread(points_of(pose)) / spread(points_of(rest));
      const double     stretch = median_stretch(rest, pose);
      if (growth < max_growth && growth > 1. / max_growth && stretch > great_stretch)
        throw UserError(prefix + "most sides of its faces are " + short_text(stretch)
                        + " times as long or longer, though it is as large as the surface at rest: "
                          "its vertices are in another order."
                        + order_remedy);
    }

    void
    check_unit(const TriangleSurface &rest, const TriangleSurface &pose, const std::string &prefix)
    {
      const double ratio = std::sqrt(total_area(pose) / total_area(rest));
      if (ratio < max_ratio && ratio > 1. / max_ratio)
        return;
      throw UserError(prefix + "it is " + short_text(ratio > 1. ? ratio : 1. / ratio) + " times "
                      + (ratio > 1. ? "larger" : "smaller")
                      + ". Export both in the same unit, and poses without scaling.");
    }

    void
    check_mirror(const TriangleSurface &rest,
                 const TriangleSurface &pose,
                 const std::string     &prefix)
    {
      const double before = enclosed_volume(rest), after = enclosed_volume(pose);
      const double unit              = std::pow(total_area(rest), 1.5);
      const bool   turned_inside_out = before * after < 0. && std::abs(before) > 1e-3 * unit
                                     && std::abs(after) > 1e-3 * unit; // flat: no volume
      TriangleSurface mirrored = rest;
      for (auto &x : mirrored.vertices)
        x[0] = -x[0];
      const bool fits = mirror_ratio * mirror_ratio * misfit(points_of(mirrored), points_of(pose))
                        < misfit(points_of(rest), points_of(pose));
      if (turned_inside_out && fits)
        throw UserError(
            prefix
            + "it is a mirror image. Cells cannot be turned inside out: export the pose "
              "with the same axes as the surface at rest, and without a negative scale.");
      if (turned_inside_out)
        throw UserError(prefix + "it is turned inside out: its faces enclose a volume of "
                        + short_text(after) + ", at rest " + short_text(before)
                        + ". Look at the pose's axes and scale, and whether it is a pose at all.");
    }
  } // namespace

  void
  require_surface(const SurfaceMesh &surface, const std::string &name)
  {
    for (std::size_t v = 0; v < surface.vertices.size(); ++v)
      for (const double coordinate : surface.vertices[v])
        if (!(std::abs(coordinate) < 1e50))
          throw UserError(
              fmt::format("{}: vertex {} lies at a coordinate that is no finite number, or larger "
                          "than 1e50. Look at the file, and export it anew.",
                          name, v + 1));
    if (surface.faces.empty())
      throw UserError(name + ": has no faces. Export the surface, not its points alone.");
    if (!(total_area(triangulate(surface)) > 0.))
      throw UserError(name
                      + ": all its faces are without area. Look at the file, and export it anew.");
  }

  void
  check_same_order(const SurfaceMesh &rest,
                   const std::string &rest_name,
                   const SurfaceMesh &pose,
                   const std::string &pose_name)
  {
    const std::string prefix = pose_name + " is no pose of " + rest_name + ": ";
    const auto        compare_counts
        = [&](const std::size_t found, const std::size_t expected, const std::string &noun)
    {
      if (found != expected)
        throw UserError(fmt::format("{}it has {}, the surface at rest {}.{}", prefix,
                                    count(found, noun), expected, order_remedy));
    };
    compare_counts(pose.vertices.size(), rest.vertices.size(), "vertex");
    compare_counts(pose.faces.size(), rest.faces.size(), "face");
    for (std::size_t f = 0; f < rest.faces.size(); ++f)
      if (pose.faces[f] != rest.faces[f])
        throw UserError(fmt::format("{}face {} has the vertices {}, at rest {}.{}", prefix, f + 1,
                                    corners(pose.faces[f]), corners(rest.faces[f]), order_remedy));
  }

  void
  check_pose(const SurfaceMesh &rest,
             const std::string &rest_name,
             const SurfaceMesh &pose,
             const std::string &pose_name)
  {
    const std::string     prefix  = pose_name + " is no pose of " + rest_name + ": ";
    const TriangleSurface at_rest = triangulate(rest);
    TriangleSurface       posed   = at_rest;
    posed.vertices                = pose.vertices;
    check_vertex_order(at_rest, posed, prefix);
    check_unit(at_rest, posed, prefix);
    check_mirror(at_rest, posed, prefix);
  }

  std::string
  axis_of_right_angle(const SurfaceMesh &rest, const SurfaceMesh &pose)
  {
    constexpr double tolerance = 0.14; // 8 degrees, as a bent body may seem to be turned
    const AxisAngle  turn      = axis_and_angle(
              best_rigid_motion(points_of(triangulate(rest)), points_of({ pose.vertices, {}, {} }))
                  .rotation);
    if (std::abs(turn.angle - std::acos(0.)) > tolerance)
      return "";
    for (unsigned int d = 0; d < 3; ++d)
      if (std::abs(turn.axis[d]) > std::cos(tolerance))
        return { "xyz"[d] };
    return "";
  }

  bool
  is_at_rest(const SurfaceMesh &rest, const SurfaceMesh &pose)
  {
    const double size = std::sqrt(total_area(triangulate(rest)));
    for (std::size_t v = 0; v < rest.vertices.size(); ++v)
      for (int d = 0; d < 3; ++d)
        if (std::abs(rest.vertices[v][d] - pose.vertices[v][d]) > 1e-9 * size)
          return false;
    return true;
  }
} // namespace Exemplar
