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

    /// The second derivative, as FoldPotential::assemble() has it and with the springs of the skin, at
    /// these places of the nodes. Throws SolverFailure if it has no factor.
    void
    factorize(const FoldPotential::Points &x, double eps);

    /// The inverse times a right side: by the factor alone, or, as that has bounds in place of the skin's
    /// springs, by conjugate gradients with the factor.
    std::vector<double>
    solve(const std::vector<double> &right_side) const;

  private:
    void
    factorize_shifted();

    const FoldPotential         &potential;
    std::unique_ptr<SpdOperator> system;
    SymmetricPattern             pattern;
    std::vector<double>          without_skin; ///< values on the pattern
  };
} // namespace Exemplar

#endif
