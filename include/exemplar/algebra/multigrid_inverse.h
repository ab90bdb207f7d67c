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
  /// Multigrid as an approximate inverse: a fixed number of cycles accelerated by Chebyshev's
  /// iteration, which is a linear symmetric positive definite operation, unlike conjugate
  /// gradients.
  class MultigridInverse : public KeptInverse
  {
  public:
    /// `row_of` is the local matrix row of each unknown. `exchange` must outlive this; each of its
    /// processes has a part of the cycle and of the rows.
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
    /// Compute `result` from right_side, which is overwritten.
    void
    solve(BlockVector &result);

    void
    count_operations();

    const Exchange                       &exchange;
    const std::vector<int>                row_of;
    const std::shared_ptr<MultigridCycle> cycle;
    BlockVector                           right_side, step; ///< update of Chebyshev's iteration
    std::pair<double, double>             spectrum; ///< of the matrix preconditioned by one cycle
    unsigned int                          n_cycles      = 0;
    double                                relative_cost = 0., relative_cost_of_column = 0.;
  };
} // namespace Exemplar

#endif
