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
    /// Integral of rho N_a [kg] at every node: for constant g the exact weights of gravity.
    std::vector<double>
    nodal_masses(const FESpace &fe_space, const Material &material)
    {
      std::vector<double> masses(fe_space.n_nodes(), 0.);
      for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
        for (const unsigned int node : fe_space.nodes(cell))
          masses[node] += material.density(cell) * fe_space.tetrahedron(cell).volume / 4.;
      return masses;
    }

    std::vector<double>
    nodal_areas(const Mesh &mesh, const std::vector<BoundaryFace> &faces)
    {
      std::vector<double> areas(mesh.n_nodes(), 0.);
      for (const BoundaryFace &face : faces)
      {
        const auto                &x      = mesh.get_nodes();
        const dealii::Tensor<1, 3> normal = dealii::cross_product_3d(
            x[face.nodes[1]] - x[face.nodes[0]], x[face.nodes[2]] - x[face.nodes[0]]);
        for (const unsigned int node : face.nodes)
          areas[node] += normal.norm() / 6.;
      }
      return areas;
    }
  } // namespace

  namespace
  {
    /// The faces between nodes; if there is none, those that have a node of them.
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
      return between.empty() ? touched : between;
    }
  } // namespace

  Loads::Loads(const dealii::Tensor<1, 3>        &gravity,
               const std::vector<LoadParameters> &parameters,
               const Mesh                        &mesh,
               const FESpace                     &fe_space,
               const Material                    &material,
               const NamedNodes                  &named_nodes)
  {
    const std::vector<double> masses = nodal_masses(fe_space, material);
    if (const double total = std::accumulate(masses.begin(), masses.end(), 0.);
        !std::isfinite(total * gravity.norm()))
      throw UserError("Loads/Gravity: the weight of the body is not a finite number. Look at "
                      "Material/Density, and at the mesh's unit.");
    if (gravity.norm() > 0.)
    {
      gravity_force.reinit(fe_space.n_dofs());
      for (unsigned int node = 0; node < fe_space.n_nodes(); ++node)
        for (unsigned int c = 0; c < 3; ++c)
          gravity_force[3 * node + c] = masses[node] * gravity[c];
    }
    for (const LoadParameters &p : parameters)
    {
      const std::string         key   = "Loads/" + p.name;
      const auto                nodes = p.select.nodes(mesh, key, named_nodes);
      const std::vector<double> weights
          = p.select.is_boundary()     ? nodal_areas(mesh, p.select.faces(mesh, key))
            : p.select.is_of_surface() ? nodal_areas(mesh, faces_between(nodes, mesh))
                                       : masses;
      const bool          by_area = p.select.is_boundary() || p.select.is_of_surface();
      std::vector<double> shares;
      for (const unsigned int node : nodes)
        shares.push_back(weights[node]);
      const double sum = std::accumulate(shares.begin(), shares.end(), 0.);
      if (!(sum > 0. && std::isfinite(sum)))
        throw UserError(
            key + ": the selected part has the " + (by_area ? "area " : "mass ")
            + shortest_text(sum)
            + ", so the force cannot be shared out. Look at Material/Density, and at the "
              "mesh's unit.");
      for (double &share : shares)
        share /= sum;
      loads.push_back({ nodes, shares, Expression(key + "/Force", p.force, "t", 3) });
    }
  }

  void
  Loads::named_loads(const double time, dealii::Vector<double> &force) const
  {
    force = 0.;
    for (const Load &load : loads)
    {
      const dealii::Tensor<1, 3> total = load.force.vector(dealii::Point<3>(), time);
      for (unsigned int i = 0; i < load.nodes.size(); ++i)
        for (unsigned int c = 0; c < 3; ++c)
          force[3 * load.nodes[i] + c] += load.shares[i] * total[c];
    }
  }
} // namespace Exemplar
