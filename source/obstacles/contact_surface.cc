// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/obstacles/contact_surface.h>

#include <algorithm>
#include <map>
#include <utility>

namespace Exemplar
{
  namespace
  {
    using Corners = std::array<unsigned int, 3>;

    /// The cell of each face, by its ascending vertices, and the vertex that the face lacks.
    std::map<Corners, std::pair<unsigned int, unsigned int>>
    cells_of_faces(const Mesh &mesh)
    {
      std::map<Corners, std::pair<unsigned int, unsigned int>> result;
      for (const BoundaryFace &face : mesh.get_boundary_faces())
      {
        Corners key = face.nodes;
        std::sort(key.begin(), key.end());
        result[key] = {};
      }
      for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
        for (unsigned int opposite = 0; opposite < 4; ++opposite)
        {
          Corners      key{};
          unsigned int n = 0;
          for (unsigned int v = 0; v < 4; ++v)
            if (v != opposite)
              key[n++] = mesh.get_cells()[cell][v];
          std::sort(key.begin(), key.end());
          if (const auto face = result.find(key); face != result.end())
            face->second = { cell, mesh.get_cells()[cell][opposite] };
        }
      return result;
    }

    /// The flat triangles of a face, of three or six nodes.
    std::vector<Corners>
    flat_triangles(const std::vector<unsigned int> &n)
    {
      if (n.size() == 3)
        return { { { n[0], n[1], n[2] } } };
      return { { { n[0], n[3], n[5] } },
               { { n[3], n[1], n[4] } },
               { { n[5], n[4], n[2] } },
               { { n[3], n[4], n[5] } } };
    }
  } // namespace

  ContactSurface::ContactSurface(const Mesh &mesh, const FESpace &fe_space)
      : bounds_solid(!mesh.is_shell())
  {
    if (bounds_solid)
      add_faces(mesh, fe_space);
    else
      add_shell(fe_space.shell());
    find_edges_and_nodes(fe_space);
  }

  void
  ContactSurface::add_faces(const Mesh &mesh, const FESpace &fe_space)
  {
    const auto cells = cells_of_faces(mesh);
    for (const BoundaryFace &face : mesh.get_boundary_faces())
    {
      Corners key = face.nodes;
      std::sort(key.begin(), key.end());
      const auto &[cell, opposite] = cells.at(key);
      for (Corners corners : flat_triangles(fe_space.numbering().of_face(face)))
      {
        const auto x = [&](const unsigned int k) { return fe_space.rest_position(corners[k]); };
        const dealii::Tensor<1, 3> n = dealii::cross_product_3d(x(1) - x(0), x(2) - x(0));
        if (n * (fe_space.rest_position(opposite) - x(0)) > 0.)
          std::swap(corners[1], corners[2]);
        triangles.push_back({ corners, cell, 0.5 * n.norm() });
      }
    }
  }

  void
  ContactSurface::add_shell(const ShellMesh &shell)
  {
    for (const ShellTriangle &triangle : shell.triangles())
      triangles.push_back({ triangle.nodes, static_cast<unsigned int>(triangles.size()),
                            triangle.area, 0.5 * triangle.thickness });
  }

  void
  ContactSurface::find_edges_and_nodes(const FESpace &fe_space)
  {
    std::map<std::array<unsigned int, 2>, double> squares;
    std::map<unsigned int, double>                areas;
    for (const Triangle &triangle : triangles)
      for (unsigned int k = 0; k < 3; ++k)
      {
        const auto [i, j] = std::minmax(triangle.nodes[k], triangle.nodes[(k + 1) % 3]);
        squares[{ { i, j } }]
            = (fe_space.rest_position(i) - fe_space.rest_position(j)).norm_square();
        areas[triangle.nodes[k]] += triangle.area / 3.;
      }
    for (const auto &[ends, square] : squares)
      edges.push_back({ ends, square });
    for (const auto &[node, area] : areas)
      nodes.push_back({ node, area });
    for (const Triangle &triangle : triangles)
      for (unsigned int k = 0; k < 3; ++k)
      {
        Edge &edge = edges[number_of_edge(triangle.nodes[k], triangle.nodes[(k + 1) % 3])];
        Node &node = nodes[number_of_node(triangle.nodes[k])];
        edge.area += triangle.area / 3.;
        edge.offset = std::max(edge.offset, triangle.offset);
        node.offset = std::max(node.offset, triangle.offset);
        greatest    = std::max(greatest, triangle.offset);
      }
  }

  void
  ContactSurface::set_material(const Material &material)
  {
    for (Edge &edge : edges)
      edge.share = 0.;
    for (Node &node : nodes)
      node.share = 0.;
    for (Triangle &triangle : triangles)
    {
      triangle.share = material.youngs_modulus(triangle.cell) * triangle.area;
      for (unsigned int k = 0; k < 3; ++k)
      {
        edges[number_of_edge(triangle.nodes[k], triangle.nodes[(k + 1) % 3])].share
            += triangle.share / 3.;
        nodes[number_of_node(triangle.nodes[k])].share += triangle.share / 3.;
      }
    }
  }

  unsigned int
  ContactSurface::number_of_edge(const unsigned int node, const unsigned int other) const
  {
    const auto [i, j] = std::minmax(node, other);
    const std::array<unsigned int, 2> ends{ { i, j } };
    return std::lower_bound(edges.begin(), edges.end(), ends,
                            [](const Edge &edge, const auto &key) { return edge.nodes < key; })
           - edges.begin();
  }

  unsigned int
  ContactSurface::number_of_node(const unsigned int node) const
  {
    return std::lower_bound(nodes.begin(), nodes.end(), node,
                            [](const Node &at, const unsigned int key) { return at.node < key; })
           - nodes.begin();
  }

  ShareDerivatives
  ContactSurface::no_derivatives() const
  {
    const std::vector<double> of_triangles(triangles.size()), of_edges(edges.size()),
        of_nodes(nodes.size());
    return { of_triangles, of_edges, of_nodes, of_edges, of_triangles, of_edges, of_nodes };
  }

  void
  ContactSurface::carry(const ShareDerivatives &by_shares,
                        const Material         &material,
                        const FESpace          &fe_space,
                        std::vector<double>    &by_young,
                        dealii::Vector<double> &by_rest_positions) const
  {
    const auto add = [&](const unsigned int node, const dealii::Tensor<1, 3> &derivative)
    {
      for (unsigned int c = 0; c < 3; ++c)
        by_rest_positions[3 * node + c] += derivative[c];
    };
    for (unsigned int t = 0; t < triangles.size(); ++t)
    {
      const Triangle &triangle = triangles[t];
      double          by_share = by_shares.triangles[t], by_area = by_shares.areas_of_triangles[t];
      for (unsigned int k = 0; k < 3; ++k)
      {
        const unsigned int edge = number_of_edge(triangle.nodes[k], triangle.nodes[(k + 1) % 3]),
                           node = number_of_node(triangle.nodes[k]);
        by_share += (by_shares.edges[edge] + by_shares.nodes[node]) / 3.;
        by_area += (by_shares.areas_of_edges[edge] + by_shares.areas_of_nodes[node]) / 3.;
      }
      if (by_share == 0. && by_area == 0.)
        continue;
      by_young[triangle.cell] += by_share * triangle.area;
      by_area += by_share * material.youngs_modulus(triangle.cell);
      const auto x
          = [&](const unsigned int k) { return fe_space.rest_position(triangle.nodes[k % 3]); };
      const dealii::Tensor<1, 3> n = dealii::cross_product_3d(x(1) - x(0), x(2) - x(0));
      // the area is half of |n|, and a corner moves it along the height over the opposite edge
      for (unsigned int k = 0; k < 3; ++k)
        add(triangle.nodes[k],
            0.5 * by_area / n.norm() * dealii::cross_product_3d(n, x(k + 2) - x(k + 1)));
    }
    for (unsigned int e = 0; e < edges.size(); ++e)
      if (by_shares.squares[e] != 0.)
      {
        const auto [i, j] = edges[e].nodes;
        const dealii::Tensor<1, 3> by_end
            = 2. * by_shares.squares[e] * (fe_space.rest_position(j) - fe_space.rest_position(i));
        add(i, -by_end);
        add(j, by_end);
      }
  }
} // namespace Exemplar
