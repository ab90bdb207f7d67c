// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_multigrid_operator_h
#define exemplar_multigrid_operator_h

#include <exemplar/algebra/multigrid_cycle.h>
#include <exemplar/algebra/rigid_correction.h>
#include <exemplar/algebra/spd_operator.h>

#include <memory>
#include <vector>

namespace Exemplar
{
  class SharedVector;

  /// The operator of make_iterative_operator(), serial or distributed: conjugate gradients on
  /// DistributedRows plus OuterProductRows, preconditioned by a MultigridCycle on the levels that a
  /// library makes of the former. Libraries take the blocks of three rows a node for their graph.
  class MultigridOperator : public SpdOperator
  {
  public:
    /// `free_dofs` must outlive this. `pieces` are those of the nodes, whose rigid motions hardly anything constrains;
    /// empty: there are none. Starts MPI if it is not running.
    MultigridOperator(const FreeDofs           &free_dofs,
                      double                    tolerance,
                      std::vector<unsigned int> pieces,
                      MakeHierarchy             make_hierarchy);

    void
    reinit(const SymmetricPattern &pattern) override;

    OperatorTraits
    traits() const override;

    std::vector<double> &
    values() override
    {
      return lower_values;
    }

    OuterProducts *
    outer_products() override
    {
      return &products;
    }

    void
    factorize(const Vector &positions) override;

    void
    factorize_near(const Vector &positions) override;

    bool
    leans_on_earlier() const override
    {
      return is_of_earlier;
    }

    void
    solve(std::vector<double> &columns, double accuracy) override;

    bool
    iterates() const override
    {
      return true;
    }

    std::unique_ptr<KeptInverse>
    keep() const override;

  private:
    /// Positions of the nodes with owned rows: x, y, z of one node after the other.
    std::vector<double>
    places_of_nodes(const Vector &positions) const;

    /// Take the values and outer products as the matrix that solve() multiplies by. Returns its outer products by block
    /// rows.
    OuterProducts
    take_matrix(const Vector &positions);

    /// Find the inverse on the rigid motions of pieces.
    void
    find_rigid_correction();

    /// Make the hierarchy of the present matrix, whose outer products by block rows are these.
    void
    make_cycle(const OuterProducts &of_rows);

    /// image = A vector, by own rows.
    void
    multiply(const Vector &vector, Vector &image) const;

    /// image = an approximation of A^-1 vector, by owned rows.
    void
    precondition(const Vector &vector, Vector &image) const;

    /// A solution to a residual of `accuracy` times the right side.
    void
    solve(double accuracy, const SharedVector &right_side, SharedVector &solution);

    /// Solve once more for the rigid motions of pieces.
    void
    correct_rigid_motions(const SharedVector &right_side, SharedVector &solution) const;

    /// Go on from `solution` to a residual of this norm for at most `limit` iterations; returns their number,
    /// `limit` + 1 if these do not suffice.
    unsigned int
    iterate(const SharedVector &right_side,
            double              residual,
            unsigned int        limit,
            SharedVector       &solution) const;

    const FreeDofs &free_dofs;
    const double    tolerance;
    const std::vector<unsigned int>
                             pieces; ///< by node of this process; empty without weak constraints
    const MakeHierarchy      make_hierarchy;
    std::vector<double>      lower_values;
    OuterProducts            products; ///< outer products by node
    DistributedRows          rows;
    OuterProductRows<double> product_rows;
    std::vector<double> places; ///< of the nodes with owned rows, where the matrix is the tangent
    RigidCorrection     rigid;  ///< of the matrix; empty if `pieces` is
    std::shared_ptr<MultigridCycle> cycle; ///< of the last factorize(), or of a matrix near it
    bool         is_of_earlier = false;    ///< whether the cycle is that of an earlier matrix
    unsigned int n_iterations
        = 0; ///< of the first solve with the cycle and its own matrix; 0: there was none
  };
} // namespace Exemplar

#endif
