// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/surface/skin/surface_skin.h>

#include <deal.II/numerics/rtree.h>

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

namespace Exemplar
{
  namespace
  {
    namespace bgi   = boost::geometry::index;
    using NodeEntry = std::pair<dealii::Point<3>, unsigned int>; // a node's place and number

    /// The reach of a vertex is reach_factor times the distance of its n_near-th nearest node: the
    /// nodes of a few cells, and of a cap of the body as wide as the vertex is distant.
    constexpr double       reach_factor = 1.5;
    constexpr unsigned int n_near       = 6;

    struct NodeWeight
    {
      unsigned int node;
      double       weight;
    };

    /// A part of the volume of its cells for each node, so that each node counts less where nodes
    /// are dense.
    std::vector<double>
    volumes_of_nodes(const Mesh &mesh)
    {
      std::vector<double> volumes(mesh.n_nodes(), 0.);
      for (const auto &cell : mesh.get_cells())
      {
        std::array<dealii::Point<3>, 4> x;
        for (int a = 0; a < 4; ++a)
          x[a] = mesh.get_nodes()[cell[a]];
        const double volume
            = std::abs(dealii::cross_product_3d(x[1] - x[0], x[2] - x[0]) * (x[3] - x[0])) / 24.;
        for (const unsigned int node : cell)
          volumes[node] += volume;
      }
      return volumes;
    }

    class NearNodes
    {
    public:
      explicit NearNodes(const Mesh &mesh) : volumes(volumes_of_nodes(mesh))
      {
        std::vector<NodeEntry> entries;
        for (unsigned int node = 0; node < mesh.n_nodes(); ++node)
          if (volumes[node] > 0.)
            entries.emplace_back(mesh.get_nodes()[node], node);
        tree = dealii::pack_rtree(entries);
      }

      /// The nodes that carry a point [m], ascending, with weights that sum to 1.
      std::vector<NodeWeight>
      around(const dealii::Point<3> &point) const
      {
        std::vector<NodeEntry> found;
        tree.query(bgi::nearest(point, n_near), std::back_inserter(found));
        double reach = 0.;
        for (const NodeEntry &entry : found)
          reach = std::max(reach, reach_factor * point.distance(entry.first));
        dealii::Point<3> low = point, high = point;
        for (unsigned int c = 0; c < 3; ++c)
        {
          low[c] -= reach;
          high[c] += reach;
        }
        found.clear();
        tree.query(bgi::intersects(dealii::BoundingBox<3>({ low, high })),
                   std::back_inserter(found));
        return weigh(found, point, reach);
      }

      double
      distance(const dealii::Point<3> &point) const
      {
        std::vector<NodeEntry> found;
        tree.query(bgi::nearest(point, 1), std::back_inserter(found));
        return point.distance(found.at(0).first);
      }

    private:
      std::vector<NodeWeight>
      weigh(std::vector<NodeEntry> found, const dealii::Point<3> &point, const double reach) const
      {
        std::sort(found.begin(), found.end(),
                  [](const NodeEntry &a, const NodeEntry &b) { return a.second < b.second; });
        std::vector<NodeWeight> result;
        double                  sum = 0.;
        for (const auto &[place, node] : found)
          if (const double rest = 1. - (place - point).norm_square() / (reach * reach); rest > 0.)
          {
            result.push_back({ node, volumes[node] * rest * rest });
            sum += result.back().weight;
          }
        for (NodeWeight &one : result)
          one.weight /= sum;
        return result;
      }

      std::vector<double>      volumes;
      dealii::RTree<NodeEntry> tree;
    };

    void
    check_distance(const NearNodes        &nodes,
                   const dealii::Point<3> &point,
                   const std::size_t       vertex,
                   const Mesh             &mesh,
                   const std::string      &name)
    {
      const double distance = nodes.distance(point), size = mesh.diameter();
      if (!(distance <= size))
        throw UserError(fmt::format("{}: vertex {} is {} times as far from the body as that is "
                                    "large. Give the surface in the unit and axes of the mesh, "
                                    "beside the body.",
                                    name, vertex + 1, short_text(distance / size)));
    }
  } // namespace

  SurfaceSkin
  skin_of_carried(const SurfaceMesh &surface, const Mesh &mesh, const std::string &name)
  {
    SurfaceSkin                          skin(surface, mesh.get_scale());
    const NearNodes                      nodes(mesh);
    std::vector<std::vector<NodeWeight>> weights;
    std::vector<dealii::Point<3>>        points;
    std::vector<bool>                    is_needed(mesh.n_nodes(), false);
    for (const SurfaceMesh::Vertex &X : surface.vertices)
    {
      points.emplace_back(skin.scale * X[0], skin.scale * X[1], skin.scale * X[2]);
      check_distance(nodes, points.back(), points.size() - 1, mesh, name);
      weights.push_back(nodes.around(points.back()));
      for (const NodeWeight &one : weights.back())
        is_needed[one.node] = true;
    }
    const MotionRecovery recovery(mesh, is_needed);
    NodalSum             sum(mesh.n_nodes());
    for (std::size_t v = 0; v < points.size(); ++v)
    {
      for (const auto &[node, weight] : weights[v])
      {
        const dealii::Tensor<1, 3> d = points[v] - mesh.get_nodes()[node];
        sum.add(node, weight);
        recovery.add_change(node, d, d, weight, sum);
      }
      const auto of_vertex = sum.take();
      skin.shares.insert(skin.shares.end(), of_vertex.begin(), of_vertex.end());
      skin.ends.push_back(skin.shares.size());
    }
    return skin;
  }
} // namespace Exemplar
