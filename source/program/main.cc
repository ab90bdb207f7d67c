// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/environment.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/mpi_session.h>
#include <exemplar/base/standard_streams.h>
#include <exemplar/program/command_line.h>
#include <exemplar/program/interrupt.h>
#include <exemplar/program/joint_run.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/multithread_info.h>

#include <csignal>
#include <iostream>
#include <new>

int
main(int argc, char *argv[])
{
  Exemplar::secure_standard_streams();
  Exemplar::end_at_interrupts();
  Exemplar::restart_with_right_core_type(argv);
  Exemplar::use_one_blas_thread();
  dealii::MultithreadInfo::set_thread_limit(1);
  std::signal(SIGXFSZ, SIG_IGN); // a write beyond ulimit -f then fails like any other
  std::signal(SIGCHLD, SIG_DFL); // if our parent ignored it, no child would tell how it ended
  dealii::deal_II_exceptions::disable_abort_on_exception();
  const Exemplar::MpiSession mpi; // scenes without multigrid on one process never start it
  const auto                 report = [](const std::string &message, const int status)
  {
    return Exemplar::JointRun::end(
        status, [&](const std::string &where)
        { std::cerr << "exemplar: " << Exemplar::message_text(message) << where << std::endl; });
  };
  try
  {
    Exemplar::JointRun::join(argc, argv);
    const int status = Exemplar::run_command_line(argc, argv);
    return Exemplar::JointRun::end(status, [](const std::string &) {});
  }
  catch (const Exemplar::UserError &error)
  {
    return report(error.what(), 1);
  }
  catch (const Exemplar::Interrupted &interruption)
  {
    return report(interruption.what(), 130);
  }
  catch (const std::bad_alloc &)
  {
    return report("There is not enough memory for this. Take a coarser mesh or fewer examples, or "
                  "let the program have more memory.",
                  2);
  }
  catch (const std::exception &error)
  {
    return report(error.what(), 2);
  }
}
