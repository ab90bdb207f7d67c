// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/mpi_session.h>
#include <exemplar/algebra/spd_operator.h>
#include <exemplar/base/errors.h>

// What stands for spd_operator_iterative.cc and mpi_session.cc in a build without Trilinos.

namespace Exemplar
{
  MpiSession::MpiSession() = default;

  MpiSession::~MpiSession() = default;

  void
  MpiSession::require()
  {
  }

  bool
  has_iterative_operator()
  {
    return false;
  }

  std::unique_ptr<SpdOperator>
  make_iterative_operator(const FreeDofs & /*free_dofs*/, const double /*tolerance*/)
  {
    throw UserError("Solver/Linear solver = iterative: this exemplar was built without Trilinos "
                    "(Epetra and ML). Set Solver/Linear solver to auto or cholesky, or build it "
                    "with a deal.II that has Trilinos.");
  }
} // namespace Exemplar
