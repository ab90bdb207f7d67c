// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/mesh/map_name.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/surface/shape/surface_paths.h>
#include <exemplar/surface/shape/vectors.h>
#include <exemplar/surface/skin/surface_selector.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    TriangleSurface
    scaled_triangles(const SurfaceMesh &surface, const double scale)
    {
      TriangleSurface triangles = triangulate(surface);
      for (auto &vertex : triangles.vertices)
        for (double &x : vertex)
          x *= scale;
      return triangles;
    }

    /// Where nodes are attached: those of the boundary, or all of a shell.
    SurfaceAttachment
    attached(const Mesh &mesh, TriangleSurface surface)
    {
      if (!mesh.is_shell())
        return { mesh.get_nodes(), mesh.get_boundary_faces(), std::move(surface) };
      std::vector<unsigned int> all(mesh.n_nodes());
      std::iota(all.begin(), all.end(), 0);
      return { std::move(all), std::move(surface) };
    }

    double
    value_at(const SurfacePoint        &point,
             const TriangleSurface     &surface,
             const std::vector<double> &values)
    {
      const auto &t   = surface.triangles[point.triangle];
      double      sum = 0.;
      for (unsigned int a = 0; a < 3; ++a)
        if (point.share[a] > 0.)
          sum += point.share[a] * values[t[a]];
      return sum;
    }

    /// Barycentric coordinates below this count as 0: the point lies on the opposite edge.
    constexpr double no_share = 1e-6;

    /// Whether points lie on triangles that are marked, or on their borders.
    class MarkedTriangles
    {
    public:
      MarkedTriangles(const TriangleSurface &surface, const std::vector<bool> &marked)
          : surface(surface), marked(marked), at(surface.vertices.size())
      {
        for (unsigned int t = 0; t < marked.size(); ++t)
          if (marked[t])
            for (const unsigned int vertex : surface.triangles[t])
              at[vertex].push_back(t);
      }

      bool
      touch(const SurfacePoint &point) const
      {
        if (marked[point.triangle])
          return true;
        std::vector<unsigned int> corners; // corners of the edge or vertex that the point lies on
        for (unsigned int a = 0; a < 3; ++a)
          if (point.share[a] > no_share)
            corners.push_back(surface.triangles[point.triangle][a]);
        const auto has_all = [&](const unsigned int t)
        {
          const auto &triangle = surface.triangles[t];
          return std::all_of(corners.begin(), corners.end(),
                             [&](const unsigned int corner)
                             { return std::count(triangle.begin(), triangle.end(), corner) > 0; });
        };
        const auto &candidates = at[corners[0]];
        return std::any_of(candidates.begin(), candidates.end(), has_all);
      }

    private:
      const TriangleSurface                 &surface;
      const std::vector<bool>               &marked;
      std::vector<std::vector<unsigned int>> at; ///< marked triangles at each vertex
    };
  } // namespace

  SurfaceSelector::SurfaceSelector(const Mesh        &mesh,
                                   const SurfaceMesh &surface,
                                   const double       scale,
                                   const std::string &surface_name)
      : mesh(mesh), surface(surface), name(surface_name),
        boundary(attached(mesh, scaled_triangles(surface, scale)))
  {
    if (!mesh.is_shell())
      check_attachment(boundary, mesh, name);
  }

  std::vector<unsigned int>
  SurfaceSelector::select(const std::string &text,
                          const std::string &key,
                          const NamedMaps   &maps) const
  {
    const std::string  choice = key + " = '" + text + "'";
    std::istringstream in(text);
    std::string        kind, words;
    in >> kind >> std::ws;
    std::getline(in, words);
    if (kind == "vertex")
      return of_vertices(words, choice);
    return kind == "group" ? of_group(words, choice) : of_map(words, choice, maps);
  }

  SurfaceSelector::Nodes
  SurfaceSelector::of_vertices(const std::string &words, const std::string &choice) const
  {
    std::string list = words;
    std::replace(list.begin(), list.end(), ',', ' ');
    std::istringstream        in(list);
    std::vector<unsigned int> vertices;
    std::string               word, extent;
    while (in >> word && word != "within")
    {
      const double number = parse_number(word);
      const auto   n      = surface.vertices.size();
      if (!(number >= 1. && number <= static_cast<double>(n)) || number != std::floor(number))
        throw UserError(fmt::format("{}: {} is no vertex of {}, whose {} vertices are counted from "
                                    "1, in the order of the file.",
                                    choice, in_quotes(word), name, n));
      vertices.push_back(static_cast<unsigned int>(number) - 1);
    }
    const bool has_extent = word == "within";
    if (has_extent)
      in >> extent >> word;
    const double distance = has_extent ? parse_number(extent) : 0.;
    if (vertices.empty() || in || !(distance >= 0. && std::isfinite(distance)))
      throw UserError(choice
                      + " is not understood. Allowed: 'vertex N' or 'vertex N within D', with "
                        "the number of a vertex of the surface, or several, and a distance D [m].");
    return has_extent ? within(vertices, distance, choice) : nearest_to(vertices);
  }

  SurfaceSelector::Nodes
  SurfaceSelector::nearest_to(const std::vector<unsigned int> &vertices) const
  {
    std::set<unsigned int> nodes;
    for (const unsigned int vertex : vertices)
    {
      const auto            &place = boundary.get_surface().vertices[vertex];
      const dealii::Point<3> x(place[0], place[1], place[2]);
      const auto            &all = boundary.get_nodes();
      nodes.insert(*std::min_element(all.begin(), all.end(),
                                     [&](const unsigned int a, const unsigned int b) {
                                       return x.distance_square(mesh.get_nodes()[a])
                                              < x.distance_square(mesh.get_nodes()[b]);
                                     }));
    }
    return { nodes.begin(), nodes.end() };
  }

  SurfaceSelector::Nodes
  SurfaceSelector::within(const std::vector<unsigned int> &vertices,
                          const double                     distance,
                          const std::string               &choice) const
  {
    using Vertices    = std::vector<unsigned int>;
    const auto select = [&](const Vertices &from, const double limit)
    {
      const SurfacePaths paths(boundary.get_surface(), from, limit);
      Nodes              nodes;
      double             minimum = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < boundary.get_nodes().size(); ++k)
      {
        const double there = paths.distance(boundary.get_points()[k]);
        minimum            = std::min(minimum, there);
        if (there <= limit)
          nodes.push_back(boundary.get_nodes()[k]);
      }
      return std::make_pair(nodes, minimum);
    };
    for (const unsigned int vertex : vertices)
      if (select({ vertex }, distance).first.empty())
      {
        const double minimum = select({ vertex }, std::numeric_limits<double>::infinity()).second;
        const std::string none
            = fmt::format("{} selects no node at vertex {}: ", choice, vertex + 1);
        if (std::isinf(minimum))
          throw UserError(
              none + "no face of the surface uses this vertex. Pick one that lies on a face.");
        throw UserError(
            none + "the nearest node of the boundary of " + mesh.get_name() + " is "
            + short_text(minimum)
            + " m away, along the surface. Enlarge the distance, or leave 'within' out to "
              "take the nearest node.");
      }
    return select(vertices, distance).first;
  }

  SurfaceSelector::Nodes
  SurfaceSelector::of_group(const std::string &group, const std::string &choice) const
  {
    const auto &names = surface.group_names;
    const auto  found = std::find(names.begin(), names.end(), group);
    if (found == names.end())
      throw UserError(choice + ": " + name + " has no group of this name (there: "
                      + (names.empty() ? "none" : printable(joined(names)))
                      + "). Groups are those of g, usemtl or o of an .obj, labels of a .ply.");
    const auto       &triangles = boundary.get_surface();
    std::vector<bool> marked;
    for (const unsigned int of_triangle : triangles.groups)
      marked.push_back(of_triangle == static_cast<unsigned int>(found - names.begin()));
    const MarkedTriangles area(triangles, marked);
    Nodes                 nodes;
    for (std::size_t k = 0; k < boundary.get_nodes().size(); ++k)
      if (area.touch(boundary.get_points()[k]))
        nodes.push_back(boundary.get_nodes()[k]);
    if (nodes.empty())
      throw UserError(fmt::format("{} selects no node: none of the boundary of {} lies on the {} "
                                  "triangles of the group. Take a finer mesh, or a larger group.",
                                  choice, mesh.get_name(),
                                  std::count(marked.begin(), marked.end(), true)));
    return nodes;
  }

  SurfaceSelector::Nodes
  SurfaceSelector::of_map(const std::string &words,
                          const std::string &choice,
                          const NamedMaps   &maps) const
  {
    const MapName      map = split_map_name(words, choice);
    std::istringstream in(map.rest);
    std::string        side = "above", bound = "0.5", more;
    if (!map.rest.empty())
    {
      bound.clear();
      in >> side >> bound >> more;
    }
    const double threshold = parse_number(bound);
    if ((side != "above" && side != "below") || !std::isfinite(threshold) || !more.empty())
      throw UserError(choice
                      + " is not understood. Allowed: 'map FILE.ply:ATTRIBUTE' or 'map "
                        "FILE.csv', and 'above X' or 'below X' behind it.");
    const auto found = maps.find(map.name());
    if (found == maps.end() || found->second.size() != surface.vertices.size())
      throw UserError(choice + ": there is no map of this name with a value for each vertex of "
                      + name + " among the inputs. Hand it in, or read it from its file.");
    std::vector<double> values = found->second;
    for (double &value : values)
      value = std::isnan(value) ? 0. : value; // the table has no value
    const double sign = side == "above" ? 1. : -1.;
    Nodes        nodes;
    double       nearest = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < boundary.get_nodes().size(); ++k)
    {
      const double value = value_at(boundary.get_points()[k], boundary.get_surface(), values);
      nearest            = std::max(nearest, sign * value);
      if (sign * value > sign * threshold)
        nodes.push_back(boundary.get_nodes()[k]);
    }
    if (nodes.empty())
      throw UserError(choice + " selects no node: at the nodes of the boundary of "
                      + mesh.get_name() + " the map is " + (sign > 0. ? "at most " : "at least ")
                      + short_text(sign * nearest) + ". Change the bound, or paint more.");
    return nodes;
  }

  std::vector<double>
  SurfaceSelector::at_cells(const std::vector<double> &values) const
  {
    std::vector<double> result;
    for (const auto &[a, b, c] : mesh.get_triangles())
      result.push_back((values[a] + values[b] + values[c]) / 3.);
    if (mesh.is_shell())
      return result;
    if (centres.empty())
    {
      std::vector<SurfaceMesh::Vertex> places;
      for (const auto &cell : mesh.get_cells())
      {
        dealii::Point<3> centre;
        for (const unsigned int node : cell)
          centre += 0.25 * mesh.get_nodes()[node];
        places.push_back({ { centre[0], centre[1], centre[2] } });
      }
      centres = closest_points(boundary.get_surface(), places);
    }
    for (const SurfacePoint &point : centres)
      result.push_back(value_at(point, boundary.get_surface(), values));
    return result;
  }

  SurfaceAttachment
  SurfaceSelector::hang(const std::vector<unsigned int> &nodes) const
  {
    if (mesh.is_shell())
      return { nodes, boundary.get_surface() };
    return { mesh.get_nodes(), nodes, boundary.get_surface() };
  }
} // namespace Exemplar
