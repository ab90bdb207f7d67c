// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/body/node_numbering.h>
#include <exemplar/mesh/mesh_edges.h>

namespace Exemplar
{
  void
  check_straight(const std::vector<dealii::Point<3>>            &places,
                 const std::vector<std::array<unsigned int, 2>> &edges,
                 const double                                    size,
                 const std::string                              &key)
  {
    const std::size_t n_nodes = places.size() - edges.size();
    for (std::size_t edge = 0; edge < edges.size(); ++edge)
    {
      const auto &[a, b] = edges[edge];
      if (const auto straight = places[a] + 0.5 * (places[b] - places[a]);
          !(places[n_nodes + edge].distance(straight) <= 1e-9 * size))
        throw UserError(key
                        + ": the pose has 10-node tetrahedra with curved edges, but "
                          "Model/Element = P1 has straight ones. Set Model/Element = P2, or give "
                          "a pose of 4-node tetrahedra.");
    }
  }

  NodeNumbering::NodeNumbering(const Mesh &mesh, const Element element, const bool has_slopes)
      : mesh(mesh), n_per_cell(mesh.is_shell() ? 3 : nodes_per_cell(element)),
        nodes_of_cells(mesh.n_cells() > 0 ? mesh.corners(0).data() : nullptr)
  {
    if (has_slopes)
      edges = edges_of(mesh.get_triangles());
    if (mesh.is_shell() || !traits_of(element).has_edge_nodes())
      return;
    edges = edges_of(mesh.get_cells());
    with_edges.reserve(n_per_cell * mesh.n_cells());
    for (const auto &cell : mesh.get_cells())
    {
      with_edges.insert(with_edges.end(), cell.begin(), cell.end());
      for (const auto &[a, b] : cell_edges)
        with_edges.push_back(middle_of(cell[a], cell[b]));
    }
    nodes_of_cells = with_edges.data();
  }

  unsigned int
  NodeNumbering::middle_of(const unsigned int a, const unsigned int b) const
  {
    return mesh.n_nodes() + find_edge(edges, a, b);
  }

  std::vector<unsigned int>
  NodeNumbering::of_face(const BoundaryFace &face) const
  {
    std::vector<unsigned int> nodes(face.nodes.begin(), face.nodes.end());
    for (unsigned int v = 0; v < 3 && !with_edges.empty(); ++v)
      nodes.push_back(middle_of(face.nodes[v], face.nodes[(v + 1) % 3]));
    return nodes;
  }

  std::vector<unsigned int>
  NodeNumbering::pieces() const
  {
    std::vector<unsigned int> of_nodes(n_nodes(), 0);
    for (unsigned int cell = 0; mesh.n_pieces() > 1 && cell < mesh.n_cells(); ++cell)
      for (const unsigned int node : of_cell(cell))
        of_nodes[node] = mesh.piece_of(cell);
    for (unsigned int edge = 0; has_slopes() && edge < edges.size(); ++edge)
      of_nodes[mesh.n_nodes() + edge] = of_nodes[edges[edge][0]];
    return of_nodes;
  }

  std::vector<unsigned int>
  NodeNumbering::fixed_dofs() const
  {
    std::vector<unsigned int> dofs;
    for (unsigned int node = n_places(); node < n_nodes(); ++node)
      for (const unsigned int c : { 1, 2 })
        dofs.push_back(3 * node + c);
    return dofs;
  }

  std::vector<unsigned int>
  NodeNumbering::with_middles(std::vector<unsigned int> vertices) const
  {
    if (edges.empty())
      return vertices;
    std::vector<bool> chosen(mesh.n_nodes(), false);
    for (const unsigned int node : vertices)
      chosen[node] = true;
    for (unsigned int edge = 0; edge < edges.size(); ++edge)
      if (chosen[edges[edge][0]] && chosen[edges[edge][1]])
        vertices.push_back(mesh.n_nodes() + edge);
    return vertices;
  }

  std::vector<dealii::Point<3>>
  NodeNumbering::complete(std::vector<dealii::Point<3>> places, const std::string &key) const
  {
    if (places.size() > n_nodes() && !mesh.is_shell())
      check_straight(places, edges_of(mesh.get_cells()), mesh.diameter(), key);
    if (places.size() == mesh.n_nodes())
      for (const auto &[a, b] : edges)
        places.push_back(0.5 * places[a] + 0.5 * dealii::Tensor<1, 3>(places[b]));
    places.resize(n_nodes());
    return places;
  }

  std::size_t
  NodeNumbering::memory_consumption() const
  {
    return edges.capacity() * sizeof(edges[0]) + with_edges.capacity() * sizeof(with_edges[0]);
  }
} // namespace Exemplar
