// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/mpi_session.h>
#include <exemplar/algebra/spd_operator.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/launcher.h>

#include <unistd.h>

// What stands for spd_operator_iterative.cc and mpi_session.cc in a build without Trilinos.

namespace Exemplar
{
  MpiSession::MpiSession() = default;

  MpiSession::~MpiSession() = default;

  void
  MpiSession::require()
  {
  }

  void
  MpiSession::join(int /*argc*/, char * /*argv*/[])
  {
    const Launch launch = find_launch();
    if (launch.is_alone())
      return;
    if (launch.process != 0)
    {
      sleep(2); // one message is enough, and who ends may end all
      _exit(1);
    }
    throw UserError(launch.program
                    + " has started several processes, but this exemplar was built without "
                      "Trilinos and MPI. Start one, or build it with a deal.II that has them.");
  }

  unsigned int
  MpiSession::n_processes()
  {
    return 1;
  }

  unsigned int
  MpiSession::process()
  {
    return 0;
  }

  void
  MpiSession::require_same(const std::string & /*text*/,
                           const std::string & /*difference*/,
                           const std::string & /*remedy*/)
  {
  }

  void
  MpiSession::wait_for_all()
  {
  }

  int
  MpiSession::end(const int status, const std::function<void(const std::string &where)> &report)
  {
    report("");
    return status;
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
