// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_adjoint_inverse_h
#define exemplar_adjoint_inverse_h

#include <exemplar/algebra/bordered_system.h>

#include <memory>
#include <vector>

namespace Exemplar
{
  /// About the inverse of a bordered system in which some weights stay as they are, and the others keep
  /// their sums: Eq. (11) with Z = A^-1 G, by a factor in single precision, which may be that of a state
  /// nearby; or by the system's own solver, where that is no factor. Vectors have no multipliers.
  class AdjointInverse
  {
  public:
    /// The system's matrix and columns are factorised and taken. Throws SolverFailure if the matrix is not
    /// positive definite.
    void
    reinit(BorderedSystem &system, const Vector &positions, const Exchange &exchange);

    bool
    empty() const
    {
      return form == nullptr;
    }

    /// From now on these weights change, and the others do not.
    void
    set_inactive(const std::vector<bool> &inactive);

    /// Overwrite a right side by its solution.
    void
    apply(BorderedVector &vector) const;

  private:
    std::vector<double>
    solve_weights(const BorderedVector &right_side) const;

    BorderedSystem              *system = nullptr;
    std::unique_ptr<KeptInverse> inverse; ///< null: the system's own solver
    const WeightForm            *form = nullptr;
    std::vector<double>          Z; ///< A^-1 G
    dealii::FullMatrix<double>   schur;
    std::vector<bool>            inactive;
    dealii::FullMatrix<double>
        of_weights; ///< inverse of the Schur complement, bordered by the sums
  };
} // namespace Exemplar

#endif
