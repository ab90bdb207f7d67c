// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/environment.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/mpi_session.h>
#include <exemplar/base/standard_streams.h>
#include <exemplar/program/interrupt.h>
#include <exemplar/program/joint_run.h>
#include <exemplar/program/run_program.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/multithread_info.h>

#include <csignal>
#include <filesystem>
#include <iostream>
#include <new>

namespace Exemplar
{
  int
  run_program(const int argc, char *argv[])
  {
    const auto report = [](const std::string &message, const int status)
    {
      return JointRun::end(
          status, [&](const std::string &where)
          { std::cerr << "exemplar: " << message_text(message) << where << std::endl; });
    };
    try
    {
      JointRun::join(argc, argv);
      if (std::error_code error; std::filesystem::current_path(error).empty())
        throw UserError("The working directory cannot be used: " + error.message()
                        + ". Change to another one, and call exemplar there.");
      const int status = run_command_line(argc, argv);
      return JointRun::end(status, [](const std::string &) {});
    }
    catch (const UserError &error)
    {
      return report(error.what(), 1);
    }
    catch (const std::filesystem::filesystem_error &error)
    {
      return report(trouble_with_path(error) + ". What was computed until then is on disk.", 2);
    }
    catch (const Interrupted &interruption)
    {
      return report(interruption.what(), 130);
    }
    catch (const std::bad_alloc &)
    {
      return report(
          "There is not enough memory for this. Take a coarser mesh or fewer examples, or "
          "let the program have more memory.",
          2);
    }
    catch (const std::exception &error)
    {
      return report(error.what(), 2);
    }
  }
} // namespace Exemplar

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
