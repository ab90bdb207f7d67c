// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_contact_gradients_h
#define exemplar_contact_gradients_h

#include <exemplar/algebra/exchange.h>
#include <exemplar/solvers/gap_energies.h>

#include <functional>
#include <vector>

namespace Exemplar
{
  /// What couples body and gaps: vectors by unknown and by row, of this process. All are collective.
  struct ContactOperators
  {
    std::function<std::vector<double>(const std::vector<double> &)> respond; ///< H times forces
    std::function<std::vector<double>(const std::vector<double> &)>
        forces; ///< U times numbers by row
    std::function<std::vector<double>(const std::vector<double> &)>
                    changes; ///< U^T times a displacement
    const Exchange &exchange;
  };

  /// A displacement, and what it changes.
  struct ContactStep
  {
    std::vector<double> step;    ///< u [m], by unknown
    std::vector<double> forces;  ///< H^-1 u [N]
    std::vector<double> changes; ///< U^T u [m], by row
  };

  /// The minimum of u.H^-1 u/2 - r.u + B(U^T u), as minimize_with_contact() of a dense problem finds it, by conjugate
  /// gradients on H^-1 + U B'' U^T, preconditioned with H: without U^T H U, for many gaps and several processes.
  ContactStep
  minimize_with_contact(const GapEnergies         &gaps,
                        const ContactOperators    &operators,
                        const std::vector<double> &r);
} // namespace Exemplar

#endif
