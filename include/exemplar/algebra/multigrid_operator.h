// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_multigrid_operator_h
#define exemplar_multigrid_operator_h

#include <exemplar/algebra/distributed_rows.h>
#include <exemplar/algebra/multigrid_hierarchy.h>
#include <exemplar/algebra/spd_operator.h>

#include <functional>
#include <memory>
#include <vector>

namespace Exemplar
{
  class SharedVector;

  /// What make_iterative_operator() makes, for one process or for several: conjugate gradients on
  /// DistributedRows, preconditioned by the multigrid of a library. Libraries take the blocks of three
  /// rows a node for their graph.
  class MultigridOperator : public SpdOperator
  {
  public:
    /// By the library: a hierarchy that points at the rows' matrix.
    using MakeHierarchy = std::function<std::unique_ptr<MultigridHierarchy>(DistributedRows &)>;

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

    void
    solve(const SharedVector &right_side, SharedVector &solution) const;

    const Exchange                     &exchange;
    const double                        tolerance;
    const MakeHierarchy                 make_hierarchy;
    std::vector<double>                 lower_values;
    DistributedRows                     rows;
    std::unique_ptr<MultigridHierarchy> hierarchy;            ///< points at the rows
    std::size_t                         multigrid_memory = 0; ///< that its making left [bytes]
  };
} // namespace Exemplar

#endif
