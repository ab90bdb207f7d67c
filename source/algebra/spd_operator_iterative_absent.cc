// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/spd_operator.h>
#include <exemplar/base/errors.h>

// Replaces spd_operator_iterative.cc in a build without Trilinos.

namespace Exemplar
{
  bool
  has_iterative_operator()
  {
    return false;
  }

  std::unique_ptr<SpdOperator>
  make_iterative_operator(const FreeDofs & /*free_dofs*/,
                          const double /*tolerance*/,
                          std::vector<unsigned int> /*pieces*/)
  {
    throw UserError(
        "Solver/Linear solver = iterative, which several processes need, too: this "
        "exemplar was built without Trilinos (Epetra and ML). Set Solver/Linear solver "
        "to auto or cholesky and start one process, or build it with a deal.II that has "
        "Trilinos.");
  }
} // namespace Exemplar
