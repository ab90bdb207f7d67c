// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/mesh.h>
#include <exemplar/surface/skin/surface_anchors.h>
#include <exemplar/surface/skin/surface_skin.h>

namespace Exemplar
{
  namespace
  {
    SurfaceMesh
    scaled(SurfaceMesh surface, const double scale)
    {
      for (SurfaceMesh::Vertex &vertex : surface.vertices)
        for (double &coordinate : vertex)
          coordinate *= scale;
      return surface;
    }

    std::vector<bool>
    nodes_of_anchors(const std::vector<SurfaceAnchor> &anchors, const Mesh &mesh)
    {
      std::vector<bool> result(mesh.n_nodes(), false);
      for (const SurfaceAnchor &anchor : anchors)
        for (const unsigned int node : anchor.nodes)
          result[node] = true;
      return result;
    }
  } // namespace

  SurfaceSkin::SurfaceSkin(const SurfaceMesh &surface,
                           const Mesh        &mesh,
                           const std::string &surface_name)
      : rest(surface.vertices), scale(mesh.get_scale())
  {
    if (mesh.is_shell()) // its vertices are those of the file
    {
      for (unsigned int v = 0; v < mesh.n_nodes(); ++v)
      {
        shares.push_back({ v, 1. });
        ends.push_back(shares.size());
      }
      return;
    }
    const SurfaceMesh                in_metres = scaled(surface, scale);
    const std::vector<SurfaceAnchor> anchors   = find_anchors(in_metres, mesh);
    if (!surface_name.empty())
      check_anchors(in_metres, anchors, mesh, scale, surface_name);
    const MotionRecovery recovery(mesh, nodes_of_anchors(anchors, mesh));
    NodalSum             sum(mesh.n_nodes());
    for (std::size_t v = 0; v < anchors.size(); ++v)
    {
      const auto                &X       = in_metres.vertices[v];
      const SurfaceAnchor       &anchor  = anchors[v];
      const dealii::Tensor<1, 3> outward = dealii::Point<3>(X[0], X[1], X[2]) - anchor.place;
      for (int a = 0; a < 4; ++a)
        if (const double share = anchor.shares[a]; share != 0.)
        {
          const unsigned int node = anchor.nodes[a];
          sum.add(node, share);
          recovery.add_change(node, .5 * (anchor.place - mesh.get_nodes()[node]) + outward, outward,
                              share, sum);
        }
      const auto of_vertex = sum.take();
      shares.insert(shares.end(), of_vertex.begin(), of_vertex.end());
      ends.push_back(shares.size());
    }
  }

  std::vector<SurfaceMesh::Vertex>
  SurfaceSkin::carry(const Vector &displacement) const
  {
    auto        places = rest;
    std::size_t i      = 0;
    for (std::size_t v = 0; v < places.size(); ++v)
    {
      SurfaceMesh::Vertex u{ { 0., 0., 0. } };
      for (; i < ends[v]; ++i)
        for (unsigned int c = 0; c < 3; ++c)
          u[c] += shares[i].coefficient * displacement[3 * shares[i].node + c];
      for (unsigned int c = 0; c < 3; ++c)
        places[v][c] += u[c] / scale;
    }
    return places;
  }

  std::vector<NodalSum::Share>
  SurfaceSkin::shares_of(const std::size_t vertex) const
  {
    const auto begin = shares.begin();
    return { begin + static_cast<std::ptrdiff_t>(vertex == 0 ? 0 : ends[vertex - 1]),
             begin + static_cast<std::ptrdiff_t>(ends[vertex]) };
  }

  dealii::Point<3>
  SurfaceSkin::place_at_rest(const std::size_t vertex) const
  {
    const SurfaceMesh::Vertex &x = rest[vertex];
    return { scale * x[0], scale * x[1], scale * x[2] };
  }
} // namespace Exemplar
