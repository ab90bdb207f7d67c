// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/child_process.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/interrupt.h>

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
    using Clock = std::chrono::steady_clock;

    /// In the forked process, where nothing but system calls is safe.
    [[noreturn]] void
    become(char *const argv[], const char *log, const pid_t parent)
    {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (getppid() != parent) // it has died before the line above
        _exit(no_such_program);
      const int in  = open("/dev/null", O_RDONLY);
      const int out = open(log, O_WRONLY | O_CREAT | O_TRUNC, 0666);
      if (in < 0 || out < 0 || dup2(in, STDIN_FILENO) < 0 || dup2(out, STDOUT_FILENO) < 0
          || dup2(out, STDERR_FILENO) < 0)
        _exit(no_such_program);
      execvp(argv[0], argv);
      _exit(no_such_program);
    }

    pid_t
    start(const std::vector<std::string> &command, const std::filesystem::path &log)
    {
      std::vector<char *> argv;
      for (const std::string &argument : command)
        argv.push_back(const_cast<char *>(argument.c_str())); // execvp does not change it
      argv.push_back(nullptr);
      const pid_t parent = getpid();
      std::signal(SIGCHLD, SIG_DFL); // if ignored, the kernel would take the status
      const pid_t child = fork();
      if (child == 0)
        become(argv.data(), log.c_str(), parent);
      if (child < 0)
        throw std::runtime_error(
            "No process can be started: " + std::generic_category().message(errno) + ".");
      return child;
    }

    /// A process that is killed if nobody has waited for its end.
    class Child
    {
    public:
      Child(const std::vector<std::string> &command, const std::filesystem::path &log)
          : id(start(command, log))
      {
      }

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
        if (!ended)
        {
          const pid_t found = waitpid(id, &status, WNOHANG);
          if (found < 0 && errno != EINTR)
            throw std::system_error(errno, std::generic_category(), "waiting for a run");
          ended = found == id;
        }
        return ended;
      }

      void
      kill() const
      {
        ::kill(id, SIGKILL);
      }

      /// Once it has ended.
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
            const double                    timeout)
  {
    ChildEnd   end;
    const auto begin = Clock::now();
    const auto seconds
        = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
    Child child(command, log);
    while (!child.has_ended())
    {
      check_interrupt();
      if (timeout > 0. && !end.timed_out && seconds() > timeout)
      {
        end.timed_out = true;
        child.kill();
      }
      // often enough for runs of a tenth of a second, and too seldom to disturb them
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    end.seconds     = seconds();
    const int state = child.get_status();
    end.signal      = WIFSIGNALED(state) ? WTERMSIG(state) : 0;
    end.exit_status = end.signal != 0 ? 128 + end.signal : WEXITSTATUS(state);
    return end;
  }
} // namespace Exemplar
