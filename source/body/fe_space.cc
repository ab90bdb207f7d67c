// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/body/fe_space.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    unsigned int
    polynomial_degree(const Element element)
    {
      return element == Element::P1 ? 1 : 2;
    }

    /// Exact for products of two gradients, with points_per_cell() points.
    dealii::Quadrature<3>
    stiffness_quadrature(const Element element)
    {
      if (element == Element::P1)
        return dealii::QGaussSimplex<3>(1);
      return dealii::QWitherdenVincentSimplex<3>(1, /* use_odd_order */ false);
    }

    /// Exact for products of two shape functions.
    dealii::Quadrature<3>
    mass_quadrature(const Element element)
    {
      if (element == Element::P1)
        return dealii::QGaussSimplex<3>(2);
      return dealii::QWitherdenVincentSimplex<3>(3);
    }
  } // namespace

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

  FESpace::FESpace(const Mesh &mesh, const Element element)
      : mesh(mesh), kind(element), fe(dealii::FE_SimplexP<3>(polynomial_degree(element)), 3),
        mapping(dealii::FE_SimplexP<3>(1))
  {
    if (kind == Element::P2)
      number_edges();
    compute_gradients();
    rest.reinit(n_dofs());
    const std::vector<dealii::Point<3>> nodes = complete(mesh.get_nodes(), "rest pose");
    for (unsigned int node = 0; node < n_nodes(); ++node)
      for (unsigned int c = 0; c < 3; ++c)
        rest[3 * node + c] = nodes[node][c];
  }

  void
  FESpace::number_edges()
  {
    edges = edges_of(mesh.get_cells());
    quadratic_cells.reserve(10 * mesh.n_cells());
    for (const auto &cell : mesh.get_cells())
    {
      quadratic_cells.insert(quadratic_cells.end(), cell.begin(), cell.end());
      for (const auto &[a, b] : cell_edges)
        quadratic_cells.push_back(node_between(cell[a], cell[b]));
    }
  }

  void
  FESpace::compute_gradients()
  {
    const dealii::Quadrature<3> quadrature = stiffness_quadrature(kind);
    dealii::FEValues<3>         fe_values(mapping, fe, quadrature,
                                          dealii::update_gradients | dealii::update_JxW_values);
    const auto                  n = static_cast<std::size_t>(nodes_per_cell(kind));
    volumes.reserve(quadrature.size() * mesh.n_cells());
    shape_gradients.reserve(n * quadrature.size() * mesh.n_cells());
    for (const auto &cell : mesh.get_triangulation().active_cell_iterators())
    {
      fe_values.reinit(cell);
      for (unsigned int v = 0; v < 4; ++v)
        AssertThrow(cell->vertex_index(v) == mesh.get_cells()[cell->active_cell_index()][v],
                    dealii::ExcMessage("deal.II has permuted the nodes of a cell"));
      for (const unsigned int q : fe_values.quadrature_point_indices())
      {
        volumes.push_back(fe_values.JxW(q));
        for (unsigned int a = 0; a < n; ++a)
        {
          const auto g = fe_values.shape_grad(fe.component_to_system_index(0, a), q);
          shape_gradients.push_back({ { g[0], g[1], g[2] } });
        }
      }
    }
  }

  void
  FESpace::share_out(const double         amount,
                     const NodeShares    &shares,
                     const unsigned int   cell,
                     std::vector<double> &values) const
  {
    const auto of_cell = nodes(cell);
    for (unsigned int a = 0; a < of_cell.size(); ++a)
      values[of_cell[a]] += a < 4 ? shares.of_vertex(amount) : shares.of_edge(amount);
  }

  std::vector<dealii::Point<3>>
  FESpace::complete(std::vector<dealii::Point<3>> places, const std::string &key) const
  {
    if (places.size() > n_nodes())
      check_straight(places, edges_of(mesh.get_cells()), mesh.diameter(), key);
    if (places.size() == mesh.n_nodes())
      for (const auto &[a, b] : edges)
        places.push_back(0.5 * places[a] + 0.5 * dealii::Tensor<1, 3>(places[b]));
    places.resize(n_nodes());
    return places;
  }

  std::vector<unsigned int>
  FESpace::with_edges(std::vector<unsigned int> nodes) const
  {
    if (edges.empty())
      return nodes;
    std::vector<bool> chosen(mesh.n_nodes(), false);
    for (const unsigned int node : nodes)
      chosen[node] = true;
    for (unsigned int edge = 0; edge < edges.size(); ++edge)
      if (chosen[edges[edge][0]] && chosen[edges[edge][1]])
        nodes.push_back(mesh.n_nodes() + edge);
    return nodes;
  }

  double
  FESpace::cell_volume(const unsigned int cell) const
  {
    const unsigned int n   = points_per_cell(kind);
    double             sum = volumes[n * cell];
    for (unsigned int q = 1; q < n; ++q)
      sum += volumes[n * cell + q];
    return sum;
  }

  void
  FESpace::nodal_forces(const unsigned int     point,
                        const Matrix3<double> &P,
                        std::vector<double>   &forces) const
  {
    forces.clear();
    for (const Vector3<double> &g : gradients(point))
    {
      const Vector3<double> force = P * g;
      for (unsigned int c = 0; c < 3; ++c)
        forces.push_back(volume(point) * force[c]);
    }
  }

  double
  FESpace::total_volume() const
  {
    double sum = 0.;
    for (const double volume : volumes)
      sum += volume;
    return exchange().sum(sum);
  }

  dealii::SparsityPattern
  FESpace::nodal_pattern() const
  {
    dealii::DynamicSparsityPattern pairs(n_nodes());
    for (unsigned int cell = 0; cell < n_cells(); ++cell)
      for (const unsigned int a : nodes(cell))
        for (const unsigned int b : nodes(cell))
          pairs.add(a, b);
    dealii::SparsityPattern pattern;
    pattern.copy_from(pairs);
    return pattern;
  }

  void
  FESpace::compute_mass_matrix(const std::vector<double>    &density_of_cell,
                               dealii::SparseMatrix<double> &mass) const
  {
    const dealii::Quadrature<3> quadrature = mass_quadrature(kind);
    dealii::FEValues<3>         fe_values(mapping, fe, quadrature,
                                          dealii::update_values | dealii::update_JxW_values);
    mass = 0.;
    for (const auto &cell : mesh.get_triangulation().active_cell_iterators())
    {
      fe_values.reinit(cell);
      const unsigned int index = cell->active_cell_index();
      const unsigned int n     = nodes_per_cell(kind);
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < n; ++b)
        {
          const unsigned int dof_a    = fe.component_to_system_index(0, a);
          const unsigned int dof_b    = fe.component_to_system_index(0, b);
          double             integral = 0.;
          for (const unsigned int q : fe_values.quadrature_point_indices())
            integral += fe_values.shape_value(dof_a, q) * fe_values.shape_value(dof_b, q)
                        * fe_values.JxW(q);
          mass.add(nodes(index)[a], nodes(index)[b], density_of_cell[index] * integral);
        }
    }
  }

  std::size_t
  FESpace::memory_consumption() const
  {
    return edges.capacity() * sizeof(edges[0])
           + quadratic_cells.capacity() * sizeof(quadratic_cells[0])
           + shape_gradients.capacity() * sizeof(shape_gradients[0])
           + volumes.capacity() * sizeof(volumes[0]) + rest.memory_consumption();
  }
} // namespace Exemplar
