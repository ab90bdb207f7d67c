// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_contact_problem_h
#define exemplar_contact_problem_h

#include <exemplar/solvers/gap_energies.h>

#include <deal.II/lac/full_matrix.h>

#include <vector>

namespace Exemplar
{
  /// The minimum of u.H^-1 u/2 - r.u + B(U^T u) over displacements u, where B are barriers and friction by rows, is at
  /// u = H (part r + U forces) with part = 1.
  struct ContactForces
  {
    double              part = 0.; ///< of r; less than 1 where the iterations have ended too early
    std::vector<double> forces;    ///< [N], by row
    std::vector<double> changes;   ///< U^T u [m]
    unsigned int        iterations = 0;
  };

  /// Find it by Newton's method, in the space of forces. `W` = U^T H U, which may be singular, `free` = U^T H r,
  /// the changes without contact, and `work` = r.H r. Each iteration leaves each gap a tenth at least. It may end where no row
  /// has a force that differs by more than `enough` [N] from that of its gap: so large may an entry of the function's gradient be.
  /// It begins at u = 0, or as near to H (r + U first) as gaps allow, with forces of the first rows.
  ContactForces
  minimize_with_contact(const GapEnergies                &gaps,
                        const dealii::FullMatrix<double> &W,
                        const std::vector<double>        &free,
                        double                            work,
                        double                            enough = 0.,
                        const std::vector<double>        &first  = {});
} // namespace Exemplar

#endif
