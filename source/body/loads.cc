// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/loads.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace Exemplar
{
  namespace
  {
    ShareRule
    rule(const bool consistent)
    {
      return consistent ? ShareRule::consistent : ShareRule::lumped;
    }

    /// Row sums of a mass matrix [kg]: nodal masses on which gravity makes a free body fall without
    /// strain. Those of the consistent matrix are the integrals of rho N_a.
    std::vector<double>
    nodal_masses(const FESpace &fe_space, const Material &material, const ShareRule mass)
    {
      std::vector<double> masses(fe_space.n_nodes(), 0.);
      for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
        fe_space.share_out(material.density(cell) * fe_space.cell_volume(cell), mass, cell, masses);
      fe_space.exchange().assemble(masses.data(), 1);
      return masses;
    }

    /// A mass [kg] at each of the chosen nodes with a non-negative sum: cells whose nodes are all
    /// chosen contribute the integral of rho N_a, other cells their lumped mass.
    std::vector<double>
    chosen_masses(const FESpace                   &fe_space,
                  const Material                  &material,
                  const std::vector<unsigned int> &nodes)
    {
      std::vector<bool> is_chosen(fe_space.n_nodes(), false);
      for (const unsigned int node : nodes)
        is_chosen[node] = true;
      std::vector<double> masses(fe_space.n_nodes(), 0.);
      for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      {
        const auto cell_nodes = fe_space.nodes(cell);
        const bool is_whole   = std::all_of(cell_nodes.begin(), cell_nodes.end(),
                                            [&](const unsigned int n) { return is_chosen[n]; });
        fe_space.share_out(material.density(cell) * fe_space.cell_volume(cell), rule(is_whole),
                           cell, masses);
      }
      fe_space.exchange().assemble(masses.data(), 1);
      return masses;
    }

    double
    area(const Mesh &mesh, const BoundaryFace &face)
    {
      const auto                &x      = mesh.get_nodes();
      const dealii::Tensor<1, 3> normal = dealii::cross_product_3d(
          x[face.nodes[1]] - x[face.nodes[0]], x[face.nodes[2]] - x[face.nodes[0]]);
      return normal.norm() / 2.;
    }

    /// Nodal areas [m^2]: the distribution of a constant traction on the faces to nodes. A
    /// quadratic face whose vertices are all chosen has consistent areas, all at the middles of its
    /// edges; other faces have lumped ones.
    std::vector<double>
    nodal_areas(const Mesh                      &mesh,
                const FESpace                   &fe_space,
                const std::vector<BoundaryFace> &faces,
                const std::vector<unsigned int> &nodes)
    {
      std::vector<double> areas(fe_space.n_nodes(), 0.);
      std::vector<bool>   is_chosen(fe_space.n_nodes(), false);
      for (const unsigned int node : nodes)
        is_chosen[node] = true;
      for (const BoundaryFace &face : faces)
      {
        const bool is_whole
            = is_chosen[face.nodes[0]] && is_chosen[face.nodes[1]] && is_chosen[face.nodes[2]];
        fe_space.share_out(area(mesh, face), rule(is_whole), face, areas);
      }
      fe_space.exchange().assemble(areas.data(), 1);
      return areas;
    }
  } // namespace

  namespace
  {
    /// Boundary faces with all vertices among `nodes`; if there are none, those with any.
    std::vector<BoundaryFace>
    faces_between(const std::vector<unsigned int> &nodes, const Mesh &mesh)
    {
      const std::set<unsigned int> chosen(nodes.begin(), nodes.end());
      std::vector<BoundaryFace>    between, touched;
      for (const BoundaryFace &face : mesh.get_boundary_faces())
      {
        const auto n
            = std::count_if(face.nodes.begin(), face.nodes.end(),
                            [&](const unsigned int node) { return chosen.count(node) == 1; });
        if (n == 3)
          between.push_back(face);
        if (n > 0)
          touched.push_back(face);
      }
      return mesh.exchange().any(!between.empty()) ? between : touched;
    }
  } // namespace

  namespace
  {
    /// Sum of nodal shares over the body; each node counts once.
    double
    sum_of_shares(const Exchange                  &exchange,
                  const std::vector<unsigned int> &nodes,
                  const std::vector<double>       &shares)
    {
      double sum = 0.;
      for (std::size_t i = 0; i < nodes.size(); ++i)
        if (exchange.owns(nodes[i]))
          sum += shares[i];
      return exchange.sum(sum);
    }
  } // namespace

  void
  Loads::set_gravity(const std::array<double, 3> &acceleration,
                     const FESpace               &fe_space,
                     const Material              &material)
  {
    const dealii::Tensor<1, 3> gravity({ acceleration[0], acceleration[1], acceleration[2] });
    const std::vector<double>  masses
        = nodal_masses(fe_space, material, rule(mass_matrix == MassMatrix::consistent));
    if (const double total = std::accumulate(masses.begin(), masses.end(), 0.);
        fe_space.exchange().any(!std::isfinite(total * gravity.norm())))
      throw UserError("Loads/Gravity: the weight of the body is not a finite number. Look at "
                      "Material/Density, and at the mesh's unit.");
    gravity_force.reinit(gravity.norm() > 0. ? fe_space.n_dofs() : 0);
    for (unsigned int dof = 0; dof < gravity_force.size(); ++dof)
      gravity_force[dof] = masses[dof / 3] * gravity[dof % 3];
  }

  Loads::Loads(const LoadsParameters &parameters,
               const Mesh            &mesh,
               const FESpace         &fe_space,
               const Material        &material,
               const NamedNodes      &named_nodes,
               const MassMatrix       mass_matrix)
      : ramp(parameters.ramp), mass_matrix(mass_matrix)
  {
    set_gravity(parameters.gravity, fe_space, material);
    for (const LoadParameters &p : parameters.named)
    {
      const std::string         load = "Loads/" + p.name, key = load + "/Select";
      const auto                vertices = p.select.nodes(mesh, key, named_nodes);
      const auto                nodes    = fe_space.numbering().with_middles(vertices);
      const std::vector<double> weights
          = p.select.is_boundary() ? nodal_areas(mesh, fe_space, p.select.faces(mesh, key), nodes)
            : p.select.is_of_surface()
                ? nodal_areas(mesh, fe_space, faces_between(vertices, mesh), nodes)
                : chosen_masses(fe_space, material, nodes);
      const bool          by_area = p.select.is_boundary() || p.select.is_of_surface();
      std::vector<double> shares;
      for (const unsigned int node : nodes)
        shares.push_back(weights[node]);
      const double sum = sum_of_shares(fe_space.exchange(), nodes, shares);
      if (!(sum > 0. && std::isfinite(sum)))
        throw UserError(
            key + ": the selected part has the " + (by_area ? "area " : "mass ")
            + shortest_text(sum)
            + ", so the force cannot be shared out. Look at Material/Density, and at the "
              "mesh's unit.");
      for (double &share : shares)
        share /= sum;
      loads.push_back({ p.name, nodes, shares, Expression(load + "/Force", p.force, "t", 3) });
    }
  }

  void
  Loads::named_loads(const double time, dealii::Vector<double> &force) const
  {
    force               = 0.;
    const double factor = ramp_factor(time);
    for (const Load &load : loads)
    {
      const dealii::Tensor<1, 3> total = factor * load.force.vector(dealii::Point<3>(), time);
      for (unsigned int i = 0; i < load.nodes.size(); ++i)
        for (unsigned int c = 0; c < 3; ++c)
          force[3 * load.nodes[i] + c] += load.shares[i] * total[c];
    }
    if (nodal_force.size() > 0)
      force.add(factor, nodal_force);
  }
} // namespace Exemplar
