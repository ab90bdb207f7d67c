// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/fe_space.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>

namespace Exemplar
{
  namespace
  {
    struct Quadratures
    {
      dealii::Quadrature<3> stiffness; ///< exact for products of two gradients, points_per_cell()
      dealii::Quadrature<3> mass;      ///< exact for products of two shape functions
    };

    Quadratures
    quadratures_of(const Element element)
    {
      const std::vector<Quadratures> in_order_of_elements
          = { { dealii::QGaussSimplex<3>(1), dealii::QGaussSimplex<3>(2) },
              { dealii::QWitherdenVincentSimplex<3>(1, /* use_odd_order */ false),
                dealii::QWitherdenVincentSimplex<3>(3) } };
      return in_order_of_elements.at(static_cast<std::size_t>(element));
    }

    /// The derivative of a cell's places by those in the reference cell.
    dealii::Tensor<2, 3>
    jacobian(const std::vector<dealii::Point<3>> &places, const std::array<unsigned int, 4> &cell)
    {
      dealii::Tensor<2, 3> J;
      for (unsigned int j = 0; j < 3; ++j)
      {
        const dealii::Tensor<1, 3> edge = places[cell[j + 1]] - places[cell[0]];
        for (unsigned int i = 0; i < 3; ++i)
          J[i][j] = edge[i];
      }
      return J;
    }

    /// Distribute an amount to nodes, of which the vertices come first.
    void
    share_among(const dealii::ArrayView<const unsigned int> &nodes,
                const unsigned int                           n_vertices,
                const NodeShares                            &shares,
                const double                                 amount,
                std::vector<double>                         &values)
    {
      for (unsigned int a = 0; a < nodes.size(); ++a)
        values[nodes[a]] += a < n_vertices ? shares.of_vertex(amount) : shares.of_edge(amount);
    }
  } // namespace

  FESpace::FESpace(const Mesh &mesh, const Element element)
      : mesh(mesh), kind(element), nodes_of_element(mesh, element), fe(traits_of(element).degree)
  {
    compute_gradients();
    rest.reinit(n_dofs());
    const std::vector<dealii::Point<3>> places
        = nodes_of_element.complete(mesh.get_nodes(), "rest pose");
    for (unsigned int node = 0; node < n_nodes(); ++node)
      for (unsigned int c = 0; c < 3; ++c)
        rest[3 * node + c] = places[node][c];
  }

  void
  FESpace::compute_gradients()
  {
    const dealii::Quadrature<3> quadrature = quadratures_of(kind).stiffness;
    const auto                  n          = static_cast<unsigned int>(nodes_per_cell(kind));
    volumes.reserve(quadrature.size() * mesh.n_cells());
    shape_gradients.reserve(n * quadrature.size() * mesh.n_cells());
    std::vector<dealii::Tensor<1, 3>> of_reference; // by point, then by node
    for (const dealii::Point<3> &point : quadrature.get_points())
      for (unsigned int a = 0; a < n; ++a)
        of_reference.push_back(fe.shape_grad(a, point));
    for (const auto &cell : mesh.get_cells())
    {
      const dealii::Tensor<2, 3> J         = jacobian(mesh.get_nodes(), cell);
      const dealii::Tensor<2, 3> transform = dealii::transpose(dealii::invert(J));
      const double               det       = dealii::determinant(J);
      for (unsigned int q = 0; q < quadrature.size(); ++q)
      {
        volumes.push_back(det * quadrature.weight(q));
        for (unsigned int a = 0; a < n; ++a)
        {
          const dealii::Tensor<1, 3> g = transform * of_reference[n * q + a];
          shape_gradients.push_back({ { g[0], g[1], g[2] } });
        }
      }
    }
  }

  void
  FESpace::share_out(const double         amount,
                     const ShareRule      rule,
                     const unsigned int   cell,
                     std::vector<double> &values) const
  {
    share_among(nodes(cell), 4, traits_of(kind).in_cell.by(rule), amount, values);
  }

  void
  FESpace::share_out(const double         amount,
                     const ShareRule      rule,
                     const BoundaryFace  &face,
                     std::vector<double> &values) const
  {
    const std::vector<unsigned int> nodes_of_face = nodes_of_element.of_face(face);
    share_among(dealii::ArrayView<const unsigned int>(nodes_of_face.data(), nodes_of_face.size()),
                3, traits_of(kind).on_face.by(rule), amount, values);
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
    const dealii::FullMatrix<double> of_unit = unit_mass_matrix();
    mass                                     = 0.;
    for (unsigned int cell = 0; cell < n_cells(); ++cell)
    {
      const double mass_of_cell = density_of_cell[cell] * cell_volume(cell);
      for (unsigned int a = 0; a < of_unit.m(); ++a)
        for (unsigned int b = 0; b < of_unit.n(); ++b)
          mass.add(nodes(cell)[a], nodes(cell)[b], mass_of_cell * of_unit(a, b));
    }
  }

  dealii::FullMatrix<double>
  FESpace::unit_mass_matrix() const
  {
    const dealii::Quadrature<3> quadrature = quadratures_of(kind).mass;
    const auto                  n          = static_cast<unsigned int>(nodes_per_cell(kind));
    dealii::FullMatrix<double>  mass(n, n);
    const auto                  shape = [&](const unsigned int a, const unsigned int q)
    { return fe.shape_value(a, quadrature.point(q)); };
    for (unsigned int a = 0; a < n; ++a)
      for (unsigned int b = 0; b < n; ++b)
        for (unsigned int q = 0; q < quadrature.size(); ++q)
          mass(a, b) += 6. * quadrature.weight(q) * shape(a, q) * shape(b, q);
    return mass;
  }

  std::size_t
  FESpace::memory_consumption() const
  {
    return nodes_of_element.memory_consumption()
           + shape_gradients.capacity() * sizeof(shape_gradients[0])
           + volumes.capacity() * sizeof(volumes[0]) + rest.memory_consumption();
  }
} // namespace Exemplar
