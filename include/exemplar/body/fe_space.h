// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_fe_space_h
#define exemplar_fe_space_h

#include <exemplar/kernels/tetrahedron.h>
#include <exemplar/mesh/mesh.h>

#include <deal.II/base/tensor.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <array>
#include <vector>

namespace Exemplar
{
  /// The finite element space FE_SimplexP(1)^3 on a mesh. Degree of freedom
  /// 3 i + c is component c of node i of the mesh file. Shape gradients and volumes
  /// are taken from deal.II's FEValues once and kept, because on linear tetrahedra
  /// they never change and the hot loops need nothing else. Nor does anything need deal.II's
  /// numbering by cells, so there is no DoFHandler, which would take 100 bytes a cell.
  class FESpace
  {
  public:
    explicit FESpace(const Mesh &mesh);

    unsigned int
    n_nodes() const
    {
      return mesh.n_nodes();
    }

    unsigned int
    n_dofs() const
    {
      return 3 * mesh.n_nodes();
    }

    unsigned int
    n_cells() const
    {
      return tetrahedra.size();
    }

    const Tetrahedron<double> &
    tetrahedron(const unsigned int cell) const
    {
      return tetrahedra[cell];
    }

    const std::array<unsigned int, 4> &
    nodes(const unsigned int cell) const
    {
      return mesh.get_cells()[cell];
    }

    /// Positions [m] of all nodes at rest, by degree of freedom.
    const dealii::Vector<double> &
    rest_positions() const
    {
      return rest;
    }

    double
    total_volume() const;

    /// Deformation gradient of a cell whose nodes are at `positions`.
    Matrix3<double>
    deformation_gradient(const unsigned int cell, const dealii::Vector<double> &positions) const
    {
      Vector3<double> x[4];
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int c = 0; c < 3; ++c)
          x[a][c] = positions[3 * nodes(cell)[a] + c];
      return Exemplar::deformation_gradient(tetrahedra[cell], x);
    }

    /// Pattern of the nodal graph: all pairs of nodes that share a cell.
    dealii::SparsityPattern
    nodal_pattern() const;

    /// Integrals of density N_a N_b over all cells [kg], by deal.II's quadrature,
    /// into a matrix on nodal_pattern(); the mass matrix is its product with I_3.
    void
    compute_mass_matrix(const std::vector<double>    &density_of_cell,
                        dealii::SparseMatrix<double> &mass) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    void
    compute_tetrahedra();

    const Mesh                      &mesh;
    const dealii::FESystem<3>        fe;
    const dealii::MappingFE<3>       mapping;
    std::vector<Tetrahedron<double>> tetrahedra;
    dealii::Vector<double>           rest;
  };
} // namespace Exemplar

#endif
