// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/fe_space.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>

namespace Exemplar
{
  FESpace::FESpace(const Mesh &mesh)
      : mesh(mesh), fe(dealii::FE_SimplexP<3>(1), 3), mapping(dealii::FE_SimplexP<3>(1)),
        rest(3 * mesh.n_nodes())
  {
    compute_tetrahedra();
    for (unsigned int node = 0; node < mesh.n_nodes(); ++node)
      for (unsigned int c = 0; c < 3; ++c)
        rest[3 * node + c] = mesh.get_nodes()[node][c];
  }

  void
  FESpace::compute_tetrahedra()
  {
    const dealii::QGaussSimplex<3> quadrature(1);
    dealii::FEValues<3>            fe_values(mapping, fe, quadrature,
                                             dealii::update_gradients | dealii::update_JxW_values);
    tetrahedra.resize(mesh.n_cells());
    for (const auto &cell : mesh.get_triangulation().active_cell_iterators())
    {
      fe_values.reinit(cell);
      const unsigned int   index = cell->active_cell_index();
      Tetrahedron<double> &tet   = tetrahedra[index];
      tet.volume                 = fe_values.JxW(0);
      for (unsigned int a = 0; a < 4; ++a)
      {
        AssertThrow(cell->vertex_index(a) == nodes(index)[a],
                    dealii::ExcMessage("deal.II has permuted the nodes of a cell"));
        const auto gradient = fe_values.shape_grad(fe.component_to_system_index(0, a), 0);
        for (unsigned int d = 0; d < 3; ++d)
          tet.shape_gradient[a][d] = gradient[d];
      }
    }
  }

  double
  FESpace::total_volume() const
  {
    double volume = 0.;
    for (const Tetrahedron<double> &tet : tetrahedra)
      volume += tet.volume;
    return volume;
  }

  dealii::SparsityPattern
  FESpace::nodal_pattern() const
  {
    dealii::DynamicSparsityPattern pairs(n_nodes());
    for (const auto &cell : mesh.get_cells())
      for (const unsigned int a : cell)
        for (const unsigned int b : cell)
          pairs.add(a, b);
    dealii::SparsityPattern pattern;
    pattern.copy_from(pairs);
    return pattern;
  }

  void
  FESpace::compute_mass_matrix(const std::vector<double>    &density_of_cell,
                               dealii::SparseMatrix<double> &mass) const
  {
    const dealii::QGaussSimplex<3> quadrature(2); // exact for products of linear functions
    dealii::FEValues<3>            fe_values(mapping, fe, quadrature,
                                             dealii::update_values | dealii::update_JxW_values);
    mass = 0.;
    for (const auto &cell : mesh.get_triangulation().active_cell_iterators())
    {
      fe_values.reinit(cell);
      const unsigned int index = cell->active_cell_index();
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int b = 0; b < 4; ++b)
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
    return tetrahedra.capacity() * sizeof(tetrahedra[0]) + rest.memory_consumption();
  }
} // namespace Exemplar
