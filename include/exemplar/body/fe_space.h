// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_fe_space_h
#define exemplar_fe_space_h

#include <exemplar/algebra/spd_operator.h>
#include <exemplar/body/node_numbering.h>
#include <exemplar/body/shell_strains.h>
#include <exemplar/kernels/tetrahedron.h>

#include <deal.II/base/tensor.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <memory>
#include <vector>

namespace Exemplar
{
  /// What a triangle of a shell is made of.
  struct ShellSection
  {
    double          thickness; ///< [m]
    ShellElasticity elasticity;
  };

  /// The finite element space FE_SimplexP(1)^3 or FE_SimplexP(2)^3 on a mesh of straight edges.
  /// Degree of freedom 3 i + c is component c of node i of its NodeNumbering. Linear elements have
  /// one quadrature point a cell, quadratic ones four; those of cell c are the points c
  /// points_per_cell() and following. Shape gradients and quadrature weights are computed once by
  /// deal.II's FEValues and kept, because they never change and the hot loops need nothing else.
  /// There is no DoFHandler, as deal.II's numbering of degrees of freedom is not needed and would
  /// take 100 bytes a cell.
  class FESpace
  {
  public:
    explicit FESpace(const Mesh &mesh, Element element = Element::P1);

    /// The space of a shell: linear triangles of these sections, with a quadrature point each, and the slopes of a plate
    /// behind the vertices, see NodeNumbering. It has no gradients of shape functions: what a shell resists, ShellStrains knows.
    FESpace(const Mesh &mesh, std::vector<ShellSection> sections, ShellKind kind);

    /// The triangles and edges of a shell; only for one.
    const ShellMesh &
    shell() const
    {
      return *shell_mesh;
    }

    /// Whether the cells are the triangles of a shell.
    bool
    is_shell() const
    {
      return mesh.is_shell();
    }

    Element
    element() const
    {
      return kind;
    }

    /// The exchange with the processes that have the other cells of the body.
    const Exchange &
    exchange() const
    {
      return mesh.exchange();
    }

    const CellOrder &
    cell_order() const
    {
      return mesh.cell_order();
    }

    const NodeNumbering &
    numbering() const
    {
      return nodes_of_element;
    }

    /// NodeNumbering::complete(); behind the vertices of a shell that has slopes come the tips of its normals, with the slopes of
    /// least bending energy where `places` has none.
    std::vector<dealii::Point<3>>
    complete(std::vector<dealii::Point<3>> places, const std::string &key) const;

    /// Positions of a shell with the tips of its normals where the bending energy is least. `elasticity` is that of a triangle.
    Vector
    with_tips_of_least_bending(
        Vector positions, const std::function<ShellElasticity(unsigned int)> &elasticity) const;

    /// Positions with the tips of all normals of a shell where they are in space, instead of the slopes of edges that are not held
    /// and of tips that follow their edges. Angles are on these branches, see ShellStrains::branches().
    Vector
    with_tips(Vector                     positions,
              const HeldTips            &held,
              const std::vector<double> &branches = {}) const;

    /// The inverse of with_tips(): positions with slopes, and slope nodes of tips that follow their edges, see TipFrame.
    Vector
    with_slopes(Vector                     positions,
                const HeldTips            &held,
                const std::vector<double> &branches = {}) const;

    /// The strains of a shell's triangles at positions with the tips of all normals.
    std::vector<ShellStrain>
    shell_strains(const Vector &positions_with_tips) const;

    unsigned int
    n_nodes() const
    {
      return nodes_of_element.n_nodes();
    }

    unsigned int
    n_dofs() const
    {
      return 3 * n_nodes();
    }

    unsigned int
    n_cells() const
    {
      return mesh.n_cells();
    }

    unsigned int
    n_points() const
    {
      return volumes.size();
    }

    /// The cell of a quadrature point.
    unsigned int
    cell_of(const unsigned int point) const
    {
      return point / static_cast<unsigned int>(points_per_cell(kind));
    }

    /// NodeNumbering::of_cell().
    dealii::ArrayView<const unsigned int>
    nodes(const unsigned int cell) const
    {
      return nodes_of_element.of_cell(cell);
    }

    /// Gradients at a point of the shape functions of nodes(), in that order [1/m].
    dealii::ArrayView<const Vector3<double>>
    gradients(const unsigned int point) const
    {
      const auto n = static_cast<std::size_t>(nodes_per_cell(kind));
      return { &shape_gradients[n * point], n };
    }

    /// Quadrature weight of a point [m^3]: the weights of a cell's points sum to its volume.
    double
    volume(const unsigned int point) const
    {
      return volumes[point];
    }

    /// volume() of all points.
    const std::vector<double> &
    get_volumes() const
    {
      return volumes;
    }

    /// Distribute an amount in a cell to `values` at its nodes, by a rule.
    void
    share_out(double amount, ShareRule rule, unsigned int cell, std::vector<double> &values) const;

    /// Distribute an amount on a boundary face to `values` at its nodes, by a rule.
    void
    share_out(double               amount,
              ShareRule            rule,
              const BoundaryFace  &face,
              std::vector<double> &values) const;

    /// Positions [m] of all nodes at rest, by degree of freedom.
    const dealii::Vector<double> &
    rest_positions() const
    {
      return rest;
    }

    /// Position of a node at rest [m].
    dealii::Point<3>
    rest_position(const unsigned int node) const
    {
      return { rest[3 * node], rest[3 * node + 1], rest[3 * node + 2] };
    }

    double
    cell_volume(unsigned int cell) const;

    /// Volume of the whole body at rest [m^3].
    double
    total_volume() const;

    /// Deformation gradient at a quadrature point for nodes at `positions`.
    Matrix3<double>
    deformation_gradient(const unsigned int point, const dealii::Vector<double> &positions) const
    {
      const auto      of_cell = nodes(cell_of(point));
      const auto      g       = gradients(point);
      Matrix3<double> F{}; // Eq. (1)
      for (unsigned int a = 0; a < of_cell.size(); ++a)
      {
        const double *x = positions.begin() + 3 * of_cell[a];
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            F[i][j] += x[i] * g[a][j];
      }
      return F;
    }

    /// The nodal forces [N] of a stress P [Pa] at a point, on the nodes() of its cell in that
    /// order, by components: volume P g for a node with shape gradient g.
    void
    nodal_forces(unsigned int point, const Matrix3<double> &P, std::vector<double> &forces) const;

    /// Sparsity pattern of the nodal graph: all pairs of nodes that share a cell.
    dealii::SparsityPattern
    nodal_pattern() const;

    /// The lower triangle of nodal_pattern(), for matrices with a number a node.
    SymmetricPattern
    lower_nodal_pattern() const;

    /// Integrals of density N_a N_b over all cells [kg], by deal.II's quadrature,
    /// into a matrix on nodal_pattern(); the mass matrix is its product with I_3.
    void
    compute_mass_matrix(const std::vector<double>    &density_of_cell,
                        dealii::SparseMatrix<double> &mass) const;

    /// The consistent mass matrix of a cell with volume 1 and density 1, on its nodes().
    dealii::FullMatrix<double>
    unit_mass_matrix() const;

    /// Memory in bytes.
    std::size_t
    memory_consumption() const;

  private:
    void
    compute_gradients();

    void
    set_rest();

    const Mesh                      &mesh;
    const Element                    kind;
    const NodeNumbering              nodes_of_element;
    const dealii::FESystem<3>        fe;
    const dealii::MappingFE<3>       mapping;
    std::vector<ShellSection>        sections;   ///< of a shell
    std::unique_ptr<const ShellMesh> shell_mesh; ///< null: none
    std::vector<Vector3<double>>     shape_gradients;
    std::vector<double>              volumes;
    dealii::Vector<double>           rest;
  };
} // namespace Exemplar

#endif
