// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_fold_system_h
#define exemplar_fold_system_h

#include <exemplar/surface/posing/fold_potential.h>

#include <memory>

namespace Exemplar
{
  /// The linear system of a step of Newton's method for a FoldPotential.
  class FoldSystem
  {
  public:
    /// `potential` must outlive this.
    explicit FoldSystem(const FoldPotential &potential);

    /// Factorizes the Hessian of FoldPotential::assemble(), with the springs of the skin, at these
    /// places of the nodes. Throws SolverFailure if it has no factor.
    void
    factorize(const FoldPotential::Points &x, double eps);

    /// The solution for a right-hand side: by the factor alone, or, with springs of the skin, of
    /// which the factor has only a diagonal bound, by conjugate gradients preconditioned by it.
    std::vector<double>
    solve(const std::vector<double> &right_side) const;

  private:
    void
    factorize_shifted();

    const FoldPotential         &potential;
    std::unique_ptr<SpdOperator> system;
    SymmetricPattern             pattern;
    std::vector<double>          without_skin; ///< Hessian without the skin's springs
  };
} // namespace Exemplar

#endif
