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
  /// Runs a program in copies of this process in its state at construction, so that the program is
  /// loaded only once: the server is such a copy, which makes another for each run. To be made
  /// before anything begins that a run of the program begins by itself: threads, MPI, random
  /// numbers.
  class ProgramServer
  {
  public:
    /// The function main().
    using Main = std::function<int(int argc, char *argv[])>;

    explicit ProgramServer(const Main &main);

    /// Ends the server and its run.
    ~ProgramServer();

    ProgramServer(const ProgramServer &) = delete;
    ProgramServer &
    operator=(const ProgramServer &)
        = delete;

    /// Run the program as run_child() does. If the server is killed, so is the run, which counts as
    /// ended in the same way; further runs are made by run_child().
    ChildEnd
    run(const std::vector<std::string> &arguments,
        const std::filesystem::path    &log,
        double                          timeout,
        const std::function<bool()>    &stop);

  private:
    /// End the server; returns its status by waitpid().
    int
    end_server();

    std::unique_ptr<Descriptor> connection; ///< null once the server has ended
    pid_t                       server;
  };
} // namespace Exemplar

#endif
