// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_fold_potential_h
#define exemplar_fold_potential_h

#include <exemplar/algebra/spd_operator.h>
#include <exemplar/kernels/tetrahedron.h>
#include <exemplar/surface/posing/skin_springs.h>

#include <deal.II/base/point.h>

#include <array>
#include <vector>

namespace Exemplar
{
  /// Springs from nodes to places, one a node.
  struct Attachment
  {
    std::vector<double>           stiffness; ///< [1/m^2]; 0: the node is free
    std::vector<dealii::Point<3>> target;    ///< [m]
  };

  /// The potential that a pose on tetrahedra minimises: the mean of fold_energy() over the rest
  /// volume plus the springs' sum_i stiffness_i |x_i - target_i|^2 / 2 and SkinSprings::energy().
  /// Without unit.
  class FoldPotential
  {
  public:
    using Points = std::vector<dealii::Point<3>>;
    using Cells  = std::vector<std::array<unsigned int, 4>>;

    /// Takes nodes at rest [m] and cells of positive volume; there are no springs yet. Results do
    /// not depend on the number of threads.
    FoldPotential(const Points &nodes, const Cells &cells, unsigned int n_threads = 1);

    /// Springs of the nodes; stiffness and target have an entry for each node.
    Attachment attachment;

    /// Springs of the vertices of a surface; none in the beginning.
    SkinSprings skin;

    /// The potential; infinite if `eps` is zero and a cell is inverted.
    double
    value(const Points &x, double eps) const;

    /// The derivative, by degree of freedom [1/m]. The energy must be finite.
    std::vector<double>
    gradient(const Points &x, double eps) const;

    /// The Hessian with each cell's eigenvalues by F bounded from below, so that it is positive
    /// definite, and without that of `skin` [1/m^2], on block_pattern().
    void
    assemble(const Points &x, double eps, std::vector<double> &values) const;

    /// det F of each cell.
    std::vector<double>
    determinants(const Points &x) const;

    /// F of a cell.
    Matrix3<double>
    gradient_of_cell(const Points &x, std::size_t cell) const;

    /// The matrix of the local-global step for the nearest rotations: the mean of |F - R|^2 with
    /// rotations R that are held, plus the springs, for each of the three components; on
    /// node_pattern().
    void
    assemble_rotations(std::vector<double> &values) const;

    /// The right-hand side of assemble_rotations() for the rotations of the cells at `x` (null: no
    /// rotation), the three components one after the other.
    std::vector<double>
    rotated_rest(const Points *x) const;

    /// Pattern with a row for each node.
    const SymmetricPattern &
    node_pattern() const
    {
      return pattern;
    }

    /// Pattern with a row for each degree of freedom.
    SymmetricPattern
    block_pattern() const;

    const Cells &
    get_cells() const
    {
      return cells;
    }

    unsigned int
    get_n_threads() const
    {
      return n_threads;
    }

    /// The rest volume of the body [m^3].
    double
    get_volume() const
    {
      return volume;
    }

  private:
    /// Blocks of the stiffness of a cell for its pairs of nodes (a, b), a <= b; the later node in
    /// the body has the rows.
    using CellBlocks = std::array<Matrix3<double>, 10>;

    void
    build_pattern(std::size_t n_nodes);
    template <typename Value, typename Function>
    std::vector<Value>
    of_cells(const Function &function) const;
    void
    add_to_block(int                    position,
                 int                    j,
                 const Matrix3<double> &block,
                 std::vector<double>   &values) const;
    CellBlocks
    blocks_of_cell(std::size_t c, const Points &x, double eps) const;
    void
    add_cell(std::size_t c, const CellBlocks &blocks, std::vector<double> &values) const;

    const unsigned int               n_threads;
    Cells                            cells;
    std::vector<Tetrahedron<double>> rest; ///< cells at rest; volumes as shares of the whole
    double                           volume = 0.;
    SymmetricPattern                 pattern;
    /// Positions in `pattern` of the node pairs (a, b), a <= b, of each cell.
    std::vector<std::array<int, 10>> positions;
  };
} // namespace Exemplar

#endif
