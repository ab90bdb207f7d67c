// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/surface/skin/cell_finder.h>
#include <exemplar/surface/skin/facing_points.h>
#include <exemplar/surface/skin/own_sheets.h>
#include <exemplar/surface/skin/surface_anchors.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    using Normals = std::vector<SpaceVector>;

    /// Greatest distances that are accepted, over the size of the body: a vertex outside the
    /// boundary, its mean, and the mean from the boundary to the surface.
    constexpr double max_outside = 0.1, mean_outside = 0.02, mean_between = 0.1;

    /// The surface of the mesh at rest; a triangle's number is that of the mesh's face.
    TriangleSurface
    boundary_triangles(const Mesh &mesh)
    {
      TriangleSurface boundary;
      for (const dealii::Point<3> &node : mesh.get_nodes())
        boundary.vertices.push_back({ { node[0], node[1], node[2] } });
      for (const BoundaryFace &face : mesh.get_boundary_faces())
        boundary.triangles.push_back(face.nodes);
      return boundary;
    }

    /// Normals of the vertices, those of their faces (Newell's) by area, pointing outwards if
    /// the surface is closed; 0 where no face uses a vertex.
    Normals
    vertex_normals(const SurfaceMesh &surface)
    {
      const auto &X      = surface.vertices;
      double      volume = 0.;
      Normals     normals(X.size(), { { 0., 0., 0. } });
      for (const auto &face : surface.faces)
      {
        SpaceVector normal{ { 0., 0., 0. } };
        for (std::size_t i = 2; i < face.size(); ++i)
        {
          normal = plus(normal, 1.,
                        cross(minus(X[face[i - 1]], X[face[0]]), minus(X[face[i]], X[face[0]])));
          volume += six_volumes(X[0], X[face[0]], X[face[i - 1]], X[face[i]]);
        }
        for (const unsigned int vertex : face)
          normals[vertex] = plus(normals[vertex], 1., normal);
      }
      for (SpaceVector &normal : normals)
        if (const double length = norm(normal); length > 0.)
          normal = plus({ { 0., 0., 0. } }, (volume < 0. ? -1. : 1.) / length, normal);
      return normals;
    }

    dealii::Point<3>
    point_at(const SpaceVector &x)
    {
      return { x[0], x[1], x[2] };
    }

    /// Nodes that share a cell with each node.
    std::vector<std::vector<unsigned int>>
    nodes_around_nodes(const Mesh &mesh)
    {
      std::vector<std::vector<unsigned int>> neighbours(mesh.n_nodes());
      for (const auto &cell : mesh.get_cells())
        for (const unsigned int node : cell)
          neighbours[node].insert(neighbours[node].end(), cell.begin(), cell.end());
      for (auto &of_node : neighbours)
      {
        std::sort(of_node.begin(), of_node.end());
        of_node.erase(std::unique(of_node.begin(), of_node.end()), of_node.end());
      }
      return neighbours;
    }

    class AnchorFinder
    {
    public:
      explicit AnchorFinder(const Mesh &mesh)
          : mesh(mesh), neighbours(nodes_around_nodes(mesh)), cells(mesh),
            boundary(boundary_triangles(mesh))
      {
      }

      std::vector<SurfaceAnchor>
      find(const SurfaceMesh &surface) const;

    private:
      SurfaceAnchor
      on_boundary(const SurfacePoint &point) const;

      /// Whether some of the way between two points is outside the mesh.
      bool
      has_gap(const dealii::Point<3> &a, const dealii::Point<3> &b) const;

      /// Whether at most two edges lead from one of `some` nodes to one of `others`. Where sheets
      /// overlap at rest, a vertex lies in cells of the other sheet, too, to which no short path
      /// leads.
      template <std::size_t n>
      bool
      are_near(const std::array<unsigned int, n> &some,
               const std::array<unsigned int, 4> &others) const;

      /// Whether two vertices are nearer than a cell is large, but no edge leads from anchor to
      /// anchor.
      bool
      are_parted(const SurfaceMesh                &surface,
                 const std::vector<SurfaceAnchor> &anchors,
                 unsigned int                      a,
                 unsigned int                      b) const;

      /// The point nearest to a place on the part of the boundary near to the anchors of `which`.
      SurfaceAnchor
      anchor_beside(const std::vector<SurfaceAnchor> &anchors,
                    const std::vector<unsigned int>  &which,
                    const SurfaceMesh::Vertex        &place) const;

      const Mesh                            &mesh;
      std::vector<std::vector<unsigned int>> neighbours; ///< adjacent nodes, and itself
      const CellFinder                       cells;
      const TriangleSurface                  boundary;
    };

    SurfaceAnchor
    AnchorFinder::on_boundary(const SurfacePoint &point) const
    {
      const auto   &t = boundary.triangles[point.triangle];
      SurfaceAnchor anchor{ { { t[0], t[1], t[2], t[0] } },
                            { { point.share[0], point.share[1], point.share[2], 0. } },
                            {} };
      for (int a = 0; a < 3; ++a)
        anchor.place += point.share[a] * mesh.get_nodes()[t[a]];
      return anchor;
    }

    template <std::size_t n>
    bool
    AnchorFinder::are_near(const std::array<unsigned int, n> &some,
                           const std::array<unsigned int, 4> &others) const
    {
      const auto touches = [&](const unsigned int node)
      { return std::find(others.begin(), others.end(), node) != others.end(); };
      for (const unsigned int corner : some)
        for (const unsigned int node : neighbours[corner])
          if (std::any_of(neighbours[node].begin(), neighbours[node].end(), touches))
            return true;
      return false;
    }

    bool
    AnchorFinder::are_parted(const SurfaceMesh                &surface,
                             const std::vector<SurfaceAnchor> &anchors,
                             const unsigned int                a,
                             const unsigned int                b) const
    {
      const auto &others  = anchors[b].nodes;
      const auto  touches = [&](const unsigned int node)
      {
        return std::any_of(others.begin(), others.end(),
                           [&](const unsigned int other) {
                             return std::binary_search(neighbours[node].begin(),
                                                       neighbours[node].end(), other);
                           });
      };
      if (std::any_of(anchors[a].nodes.begin(), anchors[a].nodes.end(), touches))
        return false;
      double size = 0.;
      for (const unsigned int node : anchors[a].nodes)
        size = std::max(size,
                        mesh.get_nodes()[node].distance(mesh.get_nodes()[anchors[a].nodes[0]]));
      return norm(minus(surface.vertices[a], surface.vertices[b])) < size;
    }

    SurfaceAnchor
    AnchorFinder::anchor_beside(const std::vector<SurfaceAnchor> &anchors,
                                const std::vector<unsigned int>  &which,
                                const SurfaceMesh::Vertex        &place) const
    {
      TriangleSurface           part{ boundary.vertices, {}, {} };
      std::vector<unsigned int> numbers;
      for (unsigned int t = 0; t < boundary.triangles.size(); ++t)
        if (std::any_of(which.begin(), which.end(),
                        [&](const unsigned int v)
                        { return are_near(boundary.triangles[t], anchors[v].nodes); }))
        {
          part.triangles.push_back(boundary.triangles[t]);
          numbers.push_back(t);
        }
      if (numbers.empty())
        return anchors[which.front()]; // all anchors are deep inside
      SurfacePoint point = closest_points(part, { place }).front();
      point.triangle     = numbers[point.triangle];
      return on_boundary(point);
    }

    bool
    AnchorFinder::has_gap(const dealii::Point<3> &a, const dealii::Point<3> &b) const
    {
      const int n = 16;
      for (int i = 1; i < n; ++i)
        if (!cells.find(a + double(i) / n * (b - a)))
          return true;
      return false;
    }

    std::vector<SurfaceAnchor>
    AnchorFinder::find(const SurfaceMesh &surface) const
    {
      const Normals              normals = vertex_normals(surface);
      const auto                 nearest = closest_points(boundary, surface.vertices);
      std::vector<SurfaceAnchor> anchors;
      for (std::size_t v = 0; v < surface.vertices.size(); ++v)
      {
        const dealii::Point<3> X = point_at(surface.vertices[v]);
        if (const auto cell = cells.find(X))
          anchors.push_back({ mesh.get_cells()[cell->cell], cell->shares, X });
        else
          anchors.push_back(on_boundary(nearest[v]));
      }
      const auto facing = facing_points(boundary, surface.vertices, normals, nearest);
      for (std::size_t v = 0; v < facing.size(); ++v)
      {
        if (!facing[v])
          continue;
        const SurfaceAnchor    other     = on_boundary(*facing[v]);
        const dealii::Point<3> X         = point_at(surface.vertices[v]);
        const bool             is_inside = anchors[v].place == X;
        if (!is_inside || has_gap(X, other.place))
          anchors[v] = other;
      }
      for (std::size_t v = 0; v < anchors.size(); ++v)
        if (const SurfacePoint &own = facing[v] ? *facing[v] : nearest[v];
            !are_near(boundary.triangles[own.triangle], anchors[v].nodes))
          anchors[v] = on_boundary(own);
      put_on_own_sheets(
          surface,
          [&](const unsigned int a, const unsigned int b)
          { return are_parted(surface, anchors, a, b); },
          [&](const unsigned int v, const std::vector<unsigned int> &right)
          { anchors[v] = anchor_beside(anchors, right, surface.vertices[v]); });
      return anchors;
    }

    /// The anchors that the mesh's own ties give; none if it has no ties, or they are those of
    /// another surface: of another number of vertices, or far from them.
    std::vector<SurfaceAnchor>
    tied_anchors(const SurfaceMesh &surface, const Mesh &mesh)
    {
      const auto                &ties = mesh.contents_of_whole().surface_ties;
      std::vector<SurfaceAnchor> anchors;
      if (ties.empty() || ties.size() != surface.vertices.size()
          || mesh.contents_of_whole().nodes.size() != mesh.n_nodes())
        return anchors;
      double sum = 0.;
      for (std::size_t v = 0; v < ties.size(); ++v)
      {
        SurfaceAnchor anchor{ {}, ties[v].shares, {} };
        for (int a = 0; a < 4; ++a)
        {
          anchor.nodes[a] = static_cast<unsigned int>(ties[v].nodes[a]);
          anchor.place += anchor.shares[a] * mesh.get_nodes()[anchor.nodes[a]];
        }
        sum += anchor.place.distance(point_at(surface.vertices[v]));
        anchors.push_back(anchor);
      }
      if (sum > mean_outside * mesh.diameter() * static_cast<double>(ties.size()))
        anchors.clear();
      return anchors;
    }

    /// Mean distance of the nodes on the mesh's boundary from a surface [unit of both].
    double
    mean_distance_of_boundary(const Mesh &mesh, const TriangleSurface &surface)
    {
      std::vector<bool> is_on_boundary(mesh.n_nodes(), false);
      for (const BoundaryFace &face : mesh.get_boundary_faces())
        for (const unsigned int node : face.nodes)
          is_on_boundary[node] = true;
      std::vector<SpaceVector> places;
      for (unsigned int node = 0; node < mesh.n_nodes(); ++node)
        if (const auto &x = mesh.get_nodes()[node]; is_on_boundary[node])
          places.push_back({ { x[0], x[1], x[2] } });
      const auto nearest = closest_points(surface, places);
      double     sum     = 0.;
      for (std::size_t i = 0; i < places.size(); ++i)
      {
        SpaceVector x{ { 0., 0., 0. } };
        for (int a = 0; a < 3; ++a)
          x = plus(x, nearest[i].share[a],
                   surface.vertices[surface.triangles[nearest[i].triangle][a]]);
        sum += norm(minus(x, places[i]));
      }
      return sum / static_cast<double>(places.size());
    }

    /// A sentence on the ratio of the sizes of surface and body; empty for ratios between 0.5 and
    /// 2.
    std::string
    size_text(const double ratio)
    {
      return ratio > .5 && ratio < 2.
                 ? ""
                 : " The surface is " + short_text(ratio) + " times as large as the body.";
    }

    [[noreturn]] void
    refuse(const std::string &surface_name, const Mesh &mesh, const std::string &why)
    {
      throw UserError(
          "Mesh/Surface: " + surface_name + " is not the surface of " + mesh.get_name() + ": " + why
          + " Both files must have the same unit, axes and place (Mesh/Scale makes metres "
            "of both): set Mesh/Surface to the surface that the mesh was made from, "
            "without what does not belong to the body, or scale one of the files.");
    }
  } // namespace

  std::vector<SurfaceAnchor>
  find_anchors(const SurfaceMesh &surface, const Mesh &mesh)
  {
    std::vector<SurfaceAnchor> tied = tied_anchors(surface, mesh);
    return tied.empty() ? AnchorFinder(mesh).find(surface) : tied;
  }

  std::vector<SurfaceTie>
  make_ties(const SurfaceMesh &surface, const Mesh &mesh)
  {
    constexpr double        digits = 1e6; // finer ones would not be seen
    std::vector<SurfaceTie> ties;
    for (const SurfaceAnchor &anchor : find_anchors(surface, mesh))
    {
      SurfaceTie tie{ { { anchor.nodes[0], anchor.nodes[1], anchor.nodes[2], anchor.nodes[3] } },
                      { { 1., 0., 0., 0. } } };
      for (int a = 1; a < 4; ++a)
      {
        tie.shares[a] = std::round(digits * anchor.shares[a]) / digits;
        tie.shares[0] -= tie.shares[a];
      }
      tie.shares[0] = std::round(digits * tie.shares[0]) / digits;
      ties.push_back(tie);
    }
    return ties;
  }

  void
  check_anchors(const SurfaceMesh                &surface,
                const std::vector<SurfaceAnchor> &anchors,
                const Mesh                       &mesh,
                const double                      scale,
                const std::string                &surface_name)
  {
    std::vector<bool> is_used(surface.vertices.size(), false);
    for (const auto &face : surface.faces)
      for (const unsigned int vertex : face)
        is_used[vertex] = true;
    const double size = mesh.diameter();
    double       sum = 0., maximum = 0.;
    std::size_t  n_used = 0, farthest = 0;
    for (std::size_t v = 0; v < anchors.size(); ++v)
      if (is_used[v])
      {
        const double distance = anchors[v].place.distance(point_at(surface.vertices[v]));
        sum += distance;
        ++n_used;
        if (distance > maximum)
        {
          maximum  = distance;
          farthest = v;
        }
      }
    const auto percent
        = [&](const double length) { return short_text(100. * length / size) + " %"; };
    const std::string ratio = size_text(diagonal_of(surface.vertices) / size);
    if (maximum > max_outside * size || sum > mean_outside * size * static_cast<double>(n_used))
      refuse(surface_name, mesh,
             fmt::format("its vertex {} is farthest outside the body, by {} of the body's size ({} "
                         "in the unit of the files), the mean is {}.{}",
                         farthest + 1, percent(maximum), short_text(maximum / scale),
                         percent(sum / static_cast<double>(n_used)), ratio));
    const TriangleSurface triangles = triangulate(surface);
    for (std::size_t t = 0; t < triangles.triangles.size(); ++t)
      if (area_of(triangles, t) > 0.)
      {
        if (const double mean = mean_distance_of_boundary(mesh, triangles);
            mean > mean_between * size)
          refuse(surface_name, mesh,
                 "the boundary of the body is " + percent(mean) + " of the body's size ("
                     + short_text(mean / scale) + " in the unit of the files) from it on average."
                     + ratio);
        break;
      }
  }
} // namespace Exemplar
