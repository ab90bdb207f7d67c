// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_multigrid_inverse_h
#define exemplar_multigrid_inverse_h

#include <exemplar/algebra/kept_inverse.h>
#include <exemplar/algebra/multigrid_cycle.h>

#include <memory>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// Multigrid as an approximate inverse: a number of cycles is accelerated by Chebyshev's iteration,
  /// so that they are one symmetric positive definite operation, which conjugate gradients are not.
  class MultigridInverse : public KeptInverse
  {
  public:
    /// `row_of` are the rows of the unknowns in the matrix. All processes of `exchange`, which must
    /// outlive this, have a part of both.
    MultigridInverse(std::shared_ptr<MultigridCycle> cycle,
                     const std::vector<int>         &row_of,
                     const Exchange                 &exchange);

    void
    apply(std::vector<double> &vector) override;

    double
    cost_in_iterations(const std::size_t n_columns) const override
    {
      return relative_cost + static_cast<double>(n_columns) * relative_cost_of_column;
    }

    std::size_t
    memory_consumption() const override;

  private:
    /// From right_side, which is lost, to `result`.
    void
    solve(BlockVector &result);

    void
    count_operations();

    const Exchange                       &exchange;
    const std::vector<int>                row_of;
    const std::shared_ptr<MultigridCycle> cycle;
    BlockVector                           right_side, step; ///< step of the polynomial
    std::pair<double, double>             spectrum; ///< of the matrix, preconditioned by a cycle
    unsigned int                          n_cycles      = 0;
    double                                relative_cost = 0., relative_cost_of_column = 0.;
  };
} // namespace Exemplar

#endif
