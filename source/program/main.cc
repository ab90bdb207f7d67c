// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/environment.h>
#include <exemplar/base/mpi_session.h>
#include <exemplar/base/standard_streams.h>
#include <exemplar/program/interrupt.h>
#include <exemplar/program/run_program.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/multithread_info.h>

#include <csignal>

int
main(int argc, char *argv[])
{
  Exemplar::secure_standard_streams();
  Exemplar::end_at_interrupts();
  Exemplar::restart_with_right_core_type(argv);
  Exemplar::use_one_blas_thread();
  dealii::MultithreadInfo::set_thread_limit(1);
  std::signal(SIGXFSZ, SIG_IGN); // a write beyond ulimit -f then fails as others do
  std::signal(SIGCHLD, SIG_DFL); // if ignored, the status of children would be lost
  dealii::deal_II_exceptions::disable_abort_on_exception();
  const Exemplar::MpiSession mpi; // starts MPI only if it is needed
  return Exemplar::run_program(argc, argv);
}
