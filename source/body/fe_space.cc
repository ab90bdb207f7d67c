// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/body/fe_space.h>
#include <exemplar/mesh/mesh_checks.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <fmt/core.h>

#include <algorithm>

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
      : mesh(mesh), kind(element), nodes_of_element(mesh, element),
        fe(dealii::FE_SimplexP<3>(traits_of(element).degree), 3), mapping(dealii::FE_SimplexP<3>(1))
  {
    compute_gradients();
    set_rest();
  }

  namespace
  {
    std::vector<Vector3<double>>
    vectors_of(const std::vector<dealii::Point<3>> &places)
    {
      std::vector<Vector3<double>> vectors;
      for (const dealii::Point<3> &x : places)
        vectors.push_back({ { x[0], x[1], x[2] } });
      return vectors;
    }

    void
    place_at(const unsigned int node, const Vector3<double> &place, Vector &positions)
    {
      for (unsigned int c = 0; c < 3; ++c)
        positions[3 * node + c] = place[c];
    }

    std::vector<double>
    thicknesses_of(const std::vector<ShellSection> &sections)
    {
      std::vector<double> thicknesses;
      for (const ShellSection &section : sections)
        thicknesses.push_back(section.thickness);
      return thicknesses;
    }
  } // namespace

  namespace
  {
    /// Throws UserError where triangles have no area, whose strains and angles are not defined.
    void
    refuse_collapsed(const std::vector<dealii::Point<3>> &places,
                     const Mesh                          &mesh,
                     const std::string                   &key)
    {
      std::vector<std::size_t> elements;
      for (unsigned int t = 0; t < mesh.get_triangles().size(); ++t)
      {
        const auto &[a, b, c] = mesh.get_triangles()[t];
        if (!has_area(places[a], places[b], places[c]))
          elements.push_back(mesh.element_number(t));
      }
      if (!elements.empty())
        throw UserError(
            fmt::format("{}: {} of {} triangles have no area there: element {}. A shell that is a "
                        "line or a point has no strains. Give places that keep its area.",
                        key, elements.size(), mesh.get_triangles().size(), list_numbers(elements)));
    }
  } // namespace

  FESpace::FESpace(const Mesh               &mesh,
                   std::vector<ShellSection> sections_of_cells,
                   const ShellKind           shell_kind)
      : mesh(mesh), kind(Element::P1), nodes_of_element(mesh, kind, shell_kind == ShellKind::plate),
        fe(dealii::FE_SimplexP<3>(1), 3), mapping(dealii::FE_SimplexP<3>(1)),
        sections(std::move(sections_of_cells)),
        shell_mesh(std::make_unique<ShellMesh>(vectors_of(mesh.get_nodes()),
                                               mesh.get_triangles(),
                                               thicknesses_of(sections),
                                               shell_kind))
  {
    for (const ShellTriangle &triangle : shell_mesh->triangles())
      volumes.push_back(triangle.volume());
    set_rest();
  }

  void
  FESpace::set_rest()
  {
    rest.reinit(n_dofs());
    std::vector<dealii::Point<3>> places = mesh.get_nodes();
    for (unsigned int edge = 0; nodes_of_element.has_slopes() && edge < shell_mesh->edges().size();
         ++edge)
    {
      const Vector3<double> tip = shell_mesh->tip(edge);
      places.emplace_back(tip[0], tip[1], tip[2]);
    }
    places = complete(std::move(places), "rest pose");
    for (unsigned int node = 0; node < n_nodes(); ++node)
      for (unsigned int c = 0; c < 3; ++c)
        rest[3 * node + c] = places[node][c];
  }

  std::vector<dealii::Point<3>>
  FESpace::complete(std::vector<dealii::Point<3>> places, const std::string &key) const
  {
    if (is_shell())
      refuse_collapsed(places, mesh, key);
    if (!nodes_of_element.has_slopes() || places.size() == n_nodes())
      return nodes_of_element.complete(std::move(places), key);
    Vector positions(n_dofs());
    for (unsigned int node = 0; node < mesh.n_nodes(); ++node)
      for (unsigned int c = 0; c < 3; ++c)
        positions[3 * node + c] = places[node][c];
    positions = with_tips_of_least_bending(std::move(positions), [this](const unsigned int triangle)
                                           { return sections[triangle].elasticity; });
    for (unsigned int node = mesh.n_nodes(); node < n_nodes(); ++node)
      places.emplace_back(positions[3 * node], positions[3 * node + 1], positions[3 * node + 2]);
    return places;
  }

  Vector
  FESpace::with_tips_of_least_bending(
      Vector positions, const std::function<ShellElasticity(unsigned int)> &elasticity) const
  {
    const ShellStrains        strains(*shell_mesh);
    const std::vector<double> slopes = strains.least_bending_slopes(positions, elasticity);
    for (unsigned int edge = 0; edge < slopes.size(); ++edge)
      positions[3 * shell_mesh->slope_node(edge)] = slopes[edge];
    return with_tips(std::move(positions), HeldTips(slopes.size(), 0));
  }

  Vector
  FESpace::with_tips(Vector                     positions,
                     const HeldTips            &held,
                     const std::vector<double> &branches) const
  {
    ShellStrains strains(*shell_mesh);
    strains.set_branches(branches);
    Vector before = positions;
    if (std::any_of(held.begin(), held.end(), follows_edge))
    {
      strains.set_held(held);
      const std::vector<double> slopes = strains.slopes(positions);
      for (unsigned int edge = 0; edge < held.size(); ++edge)
        before[3 * shell_mesh->slope_node(edge)] = slopes[edge];
    }
    for (unsigned int edge = 0; edge < held.size(); ++edge)
      if (held[edge] != held_in_space)
        place_at(shell_mesh->slope_node(edge), strains.tip(edge, before), positions);
    return positions;
  }

  Vector
  FESpace::with_slopes(Vector                     positions,
                       const HeldTips            &held,
                       const std::vector<double> &branches) const
  {
    ShellStrains strains(*shell_mesh);
    strains.set_branches(branches);
    strains.set_held(HeldTips(held.size(), held_in_space));
    const std::vector<double> slopes = strains.slopes(positions);
    strains.set_held(held);
    for (unsigned int edge = 0; edge < held.size(); ++edge)
    {
      const unsigned int node = shell_mesh->slope_node(edge);
      if (held[edge] == 0)
        place_at(node, { { slopes[edge], 0., 0. } }, positions);
      else
        place_at(node, strains.held_node(edge, place_in(positions, node), positions), positions);
    }
    return positions;
  }

  std::vector<ShellStrain>
  FESpace::shell_strains(const Vector &positions_with_tips) const
  {
    ShellStrains strains(*shell_mesh);
    if (nodes_of_element.has_slopes())
      strains.set_held(HeldTips(shell_mesh->edges().size(), held_in_space));
    return strains.strains(positions_with_tips);
  }

  void
  FESpace::compute_gradients()
  {
    const dealii::Quadrature<3> quadrature = quadratures_of(kind).stiffness;
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
                     const ShareRule      rule,
                     const unsigned int   cell,
                     std::vector<double> &values) const
  {
    if (is_shell())
      for (const unsigned int node : nodes(cell))
        values[node] += amount / 3.;
    else
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

  SymmetricPattern
  FESpace::lower_nodal_pattern() const
  {
    const dealii::SparsityPattern nodal = nodal_pattern();
    SymmetricPattern              pattern;
    pattern.column_start.push_back(0);
    for (unsigned int node = 0; node < n_nodes(); ++node)
    {
      for (auto entry = nodal.begin(node); entry != nodal.end(node); ++entry)
        if (entry->column() >= node)
          pattern.row.push_back(static_cast<int>(entry->column()));
      std::sort(pattern.row.begin() + pattern.column_start.back(), pattern.row.end());
      pattern.column_start.push_back(static_cast<int>(pattern.row.size()));
    }
    return pattern;
  }

  void
  FESpace::compute_mass_matrix(const std::vector<double>    &density_of_cell,
                               dealii::SparseMatrix<double> &mass) const
  {
    mass = 0.;
    if (is_shell())
    {
      for (unsigned int cell = 0; cell < n_cells(); ++cell)
        for (const unsigned int a : nodes(cell))
          for (const unsigned int b : nodes(cell))
            mass.add(a, b, density_of_cell[cell] * volumes[cell] * (a == b ? 2. : 1.) / 12.);
      return;
    }
    const dealii::Quadrature<3> quadrature = quadratures_of(kind).mass;
    dealii::FEValues<3>         fe_values(mapping, fe, quadrature,
                                          dealii::update_values | dealii::update_JxW_values);
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

  dealii::FullMatrix<double>
  FESpace::unit_mass_matrix() const
  {
    const dealii::Quadrature<3> quadrature = quadratures_of(kind).mass;
    const auto                  n          = static_cast<unsigned int>(nodes_per_cell(kind));
    dealii::FullMatrix<double>  mass(n, n);
    const auto                  shape = [&](const unsigned int a, const unsigned int q)
    { return fe.shape_value(fe.component_to_system_index(0, a), quadrature.point(q)); };
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
