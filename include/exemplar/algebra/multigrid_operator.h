// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_multigrid_operator_h
#define exemplar_multigrid_operator_h

#include <exemplar/algebra/exchange.h>
#include <exemplar/algebra/spd_operator.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_Map.h>
#include <memory>
#include <ml_MultiLevelPreconditioner.h>
#include <mpi.h>
#include <vector>

namespace Exemplar
{
  class SharedVector;

  /// What make_iterative_operator() makes, for one process or for several: all but where the values
  /// of the matrix go. It has a block of three rows for every node that is not held as a whole,
  /// since ML takes the blocks for its graph. In the row of a held component is the unit matrix,
  /// and all vectors are zero there. The rows of a node are at the process that owns it.
  class MultigridOperator : public SpdOperator
  {
  public:
    /// `free_dofs` must outlive this. Starts MPI if it does not run.
    MultigridOperator(const FreeDofs &free_dofs, double tolerance);

    ~MultigridOperator() override;

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

  protected:
    unsigned int
    n_rows() const
    {
      return places.size();
    }

    /// Throws SolverFailure, in all processes, if a matrix would have more entries in one of them
    /// than Epetra can count.
    void
    check_size(std::size_t n_entries) const;

    const FreeDofs                   &free_dofs;
    std::vector<unsigned int>         nodes;  ///< those with rows
    std::vector<int>                  row_of; ///< of each unknown
    std::vector<double>               lower_values;
    std::unique_ptr<Epetra_CrsMatrix> matrix;

  private:
    /// `matrix` for a pattern of the lower triangle; its values do not matter.
    virtual void
    make_matrix(const SymmetricPattern &pattern)
        = 0;

    /// The values of the lower triangle, of which each process has its cells' part, to the rows of
    /// the matrix. Throws SolverFailure in all processes if an entry of the diagonal is not positive.
    virtual void
    fill_matrix()
        = 0;

    void
    place_nodes(const Vector &positions);

    void
    make_multigrid();

    void
    solve(const SharedVector &right_side, SharedVector &solution) const;

    const double                                         tolerance;
    std::vector<double>                                  places; ///< of the nodes, by row
    std::unique_ptr<ML_Epetra::MultiLevelPreconditioner> multigrid;
    std::size_t multigrid_memory = 0; ///< what its making has left on the heap [bytes]
  };

  /// make_iterative_operator() for several processes, those of the unknowns' exchange.
  std::unique_ptr<SpdOperator>
  make_distributed_operator(const FreeDofs &free_dofs, double tolerance);
} // namespace Exemplar

#endif
