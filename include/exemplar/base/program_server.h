// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_program_server_h
#define exemplar_program_server_h

#include <exemplar/base/child_process.h>
#include <exemplar/base/descriptor.h>

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Runs a program in copies of this process as it is when the server is made, so that loading the
  /// program is paid once: the server is such a copy, which makes another for each run. Make it before
  /// anything has begun that a run of the program begins by itself: threads, MPI, random numbers.
  class ProgramServer
  {
  public:
    /// What main() does, and returns.
    using Main = std::function<int(int argc, char *argv[])>;

    explicit ProgramServer(const Main &main);

    /// Ends the server, and with it what it runs.
    ~ProgramServer();

    ProgramServer(const ProgramServer &) = delete;
    ProgramServer &
    operator=(const ProgramServer &)
        = delete;

    /// As run_child(). If the server is killed, so is the run, which has ended in the same way; further
    /// runs are made by run_child().
    ChildEnd
    run(const std::vector<std::string> &arguments,
        const std::filesystem::path    &log,
        double                          timeout,
        const std::function<bool()>    &stop);

  private:
    /// Returns the status that waitpid() tells.
    int
    end_server();

    std::unique_ptr<Descriptor> connection; ///< null once the server has ended
    pid_t                       server;
  };
} // namespace Exemplar

#endif
