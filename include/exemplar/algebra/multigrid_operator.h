// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_multigrid_operator_h
#define exemplar_multigrid_operator_h

#include <exemplar/algebra/multigrid_cycle.h>
#include <exemplar/algebra/spd_operator.h>

#include <memory>
#include <vector>

namespace Exemplar
{
  class SharedVector;

  /// What make_iterative_operator() makes, for one process or for several: conjugate gradients on
  /// DistributedRows and OuterProductRows, preconditioned by a MultigridCycle of the levels that a
  /// library makes of the former. Libraries take the blocks of three rows a node for their graph.
  class MultigridOperator : public SpdOperator
  {
  public:
    /// `free_dofs` must outlive this. Starts MPI if it does not run.
    MultigridOperator(const FreeDofs &free_dofs, double tolerance, MakeHierarchy make_hierarchy);

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
    solve(std::vector<double> &columns) override;

    std::unique_ptr<KeptInverse>
    keep() const override;

  private:
    /// Of the nodes with rows, x, y, z of one after the other.
    std::vector<double>
    places_of_nodes(const Vector &positions) const;

    /// image = A vector, by own rows.
    void
    multiply(const Vector &vector, Vector &image) const;

    /// image = about A^-1 vector, by own rows.
    void
    precondition(const Vector &vector, Vector &image) const;

    void
    solve(const SharedVector &right_side, SharedVector &solution) const;

    const FreeDofs                 &free_dofs;
    const double                    tolerance;
    const MakeHierarchy             make_hierarchy;
    std::vector<double>             lower_values;
    OuterProducts                   products; ///< by node
    DistributedRows                 rows;
    OuterProductRows<double>        product_rows;
    std::shared_ptr<MultigridCycle> cycle; ///< of the last factorize()
  };
} // namespace Exemplar

#endif
