// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/child_process.h>
#include <exemplar/base/descriptor.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/time_limit.h>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <system_error>
#include <thread>

namespace Exemplar
{
  namespace
  {
    /// Replace the forked process by the program; only async-signal-safe calls are allowed here.
    [[noreturn]] void
    become(char *const argv[], const int out, const pid_t parent)
    {
      for (const int signal : { SIGPIPE, SIGXFSZ }) // ignored signals would stay ignored
        std::signal(signal, SIG_DFL);
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (getppid() != parent) // the parent has died before the line above
        _exit(no_such_program);
      const int in = open("/dev/null", O_RDONLY);
      if (in < 0 || dup2(in, STDIN_FILENO) < 0 || dup2(out, STDOUT_FILENO) < 0
          || dup2(out, STDERR_FILENO) < 0)
        _exit(no_such_program);
      execvp(argv[0], argv);
      _exit(no_such_program);
    }

    pid_t
    start(const std::vector<std::string> &command, const int out)
    {
      std::vector<char *> argv;
      for (const std::string &argument : command)
        argv.push_back(const_cast<char *>(argument.c_str())); // execvp does not change it
      argv.push_back(nullptr);
      const pid_t parent = getpid();
      const pid_t child  = fork();
      if (child == 0)
        become(argv.data(), out, parent);
      if (child < 0)
        throw std::runtime_error(
            "No process can be started: " + std::generic_category().message(errno) + ".");
      return child;
    }

    /// A process that is killed by the destructor if it has not been waited for.
    class Child
    {
    public:
      Child(const std::vector<std::string> &command, const int out) : id(start(command, out)) {}

      Child(const Child &) = delete;
      Child &
      operator=(const Child &)
          = delete;

      ~Child()
      {
        if (!ended)
        {
          kill();
          waitpid(id, &status, 0);
        }
      }

      bool
      has_ended()
      {
        if (ended)
          return true;
        siginfo_t found{};
        if (waitid(P_PID, static_cast<id_t>(id), &found, WEXITED | WNOHANG | WNOWAIT) != 0
            && errno != EINTR)
          throw std::system_error(errno, std::generic_category(), "waiting for a process");
        if (found.si_pid != id)
          return false;
        ended = waitpid(id, &status, 0) == id;
        return ended;
      }

      pid_t
      get_id() const
      {
        return id;
      }

      void
      kill() const
      {
        ::kill(id, SIGKILL);
      }

      /// The status of waitpid(), once the process has ended.
      int
      get_status() const
      {
        return status;
      }

    private:
      const pid_t id;
      int         status = 0;
      bool        ended  = false;
    };
  } // namespace

  ChildEnd
  run_child(const std::vector<std::string> &command,
            const std::filesystem::path    &log,
            const double                    timeout,
            const std::function<bool()>    &stop)
  {
    const Descriptor out(open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (out.number < 0)
      throw std::system_error(errno, std::generic_category(), log.string());
    ChildEnd        end;
    const TimeLimit time(timeout);
    Child           child(command, out.number);
    while (!child.has_ended())
    {
      if (stop && stop())
        throw Interrupted("Interrupted.");
      if (timeout > 0. && end.exceeded.empty())
        end.exceeded = time.exceeded_by(child.get_id()).value_or("");
      if (!end.exceeded.empty())
        child.kill();
      // often enough for runs of a tenth of a second, and too seldom to disturb them
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    end.seconds     = time.seconds();
    const int state = child.get_status();
    end.signal      = WIFSIGNALED(state) ? WTERMSIG(state) : 0;
    end.exit_status = end.signal != 0 ? 128 + end.signal : WEXITSTATUS(state);
    return end;
  }
} // namespace Exemplar
