// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/child_process.h>
#include <exemplar/base/errors.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
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

    /// An open file, closed at the end.
    class OpenFile
    {
    public:
      /// What open() or the like has returned; throws if that is an error.
      OpenFile(const int descriptor, const std::string &name) : descriptor(descriptor)
      {
        if (descriptor < 0)
          throw std::system_error(errno, std::generic_category(), name);
      }

      ~OpenFile()
      {
        close(descriptor);
      }

      OpenFile(const OpenFile &) = delete;
      OpenFile &
      operator=(const OpenFile &)
          = delete;

      std::string
      text_from_begin() const
      {
        std::string text;
        char        buffer[4096];
        for (ssize_t n; (n = pread(descriptor, buffer, sizeof(buffer), text.size())) > 0;)
          text.append(buffer, n);
        return text;
      }

      std::uintmax_t
      size() const
      {
        struct stat status;
        return fstat(descriptor, &status) == 0 ? static_cast<std::uintmax_t>(status.st_size) : 0;
      }

      const int descriptor;
    };

    /// How a process is started, and what makes an end of it.
    struct Task
    {
      const std::vector<std::string> &command;
      const OpenFile                 &out;       ///< takes its output and errors
      std::string                     directory; ///< empty: this one
      bool                            has_group; ///< a process group of its own
    };

    /// In the forked process, where nothing but system calls is safe.
    [[noreturn]] void
    become(char *const argv[], const Task &task, const pid_t parent)
    {
      const int out = task.out.descriptor;
      if (task.has_group && setpgid(0, 0) != 0)
        _exit(no_such_program);
      if (!task.directory.empty() && chdir(task.directory.c_str()) != 0)
        _exit(no_such_program);
      for (const int signal : { SIGPIPE, SIGXFSZ }) // what we ignore would stay ignored
        std::signal(signal, SIG_DFL);
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (getppid() != parent) // it has died before the line above
        _exit(no_such_program);
      const int in = open("/dev/null", O_RDONLY);
      if (in < 0 || dup2(in, STDIN_FILENO) < 0 || dup2(out, STDOUT_FILENO) < 0
          || dup2(out, STDERR_FILENO) < 0)
        _exit(no_such_program);
      execvp(argv[0], argv);
      _exit(no_such_program);
    }

    pid_t
    start(const Task &task)
    {
      std::vector<char *> argv;
      for (const std::string &argument : task.command)
        argv.push_back(const_cast<char *>(argument.c_str())); // execvp does not change it
      argv.push_back(nullptr);
      const pid_t parent = getpid();
      const pid_t child  = fork();
      if (child == 0)
        become(argv.data(), task, parent);
      if (child < 0)
        throw std::runtime_error(
            "No process can be started: " + std::generic_category().message(errno) + ".");
      if (task.has_group)
        setpgid(child, child); // here and there, as nobody knows who is first
      return child;
    }

    /// A process that is killed if nobody has waited for its end, with its group if it has one.
    class Child
    {
    public:
      explicit Child(const Task &task) : id(start(task)), group(task.has_group ? -id : id) {}

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
        if (group != id)
          kill(); // while its number is still its own
        ended = waitpid(id, &status, 0) == id;
        return ended;
      }

      void
      kill() const
      {
        ::kill(group, SIGKILL);
      }

      /// Once it has ended.
      int
      get_status() const
      {
        return status;
      }

    private:
      const pid_t id;
      const pid_t group; ///< what a signal is sent to
      int         status = 0;
      bool        ended  = false;
    };

    ChildEnd
    run(const Task                  &task,
        const double                 timeout,
        const std::uintmax_t         max_output_bytes,
        const std::function<bool()> &stop)
    {
      ChildEnd   end;
      const auto begin = Clock::now();
      const auto seconds
          = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
      Child child(task);
      while (!child.has_ended())
      {
        if (stop && stop())
          throw Interrupted("Interrupted.");
        end.timed_out     = end.timed_out || (timeout > 0. && seconds() > timeout);
        end.said_too_much = end.said_too_much || task.out.size() > max_output_bytes;
        if (end.timed_out || end.said_too_much)
          child.kill();
        // often enough for runs of a tenth of a second, and too seldom to disturb them
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
      end.seconds     = seconds();
      const int state = child.get_status();
      end.signal      = WIFSIGNALED(state) ? WTERMSIG(state) : 0;
      end.exit_status = end.signal != 0 ? 128 + end.signal : WEXITSTATUS(state);
      return end;
    }
  } // namespace

  ChildEnd
  run_child(const std::vector<std::string> &command,
            const std::filesystem::path    &log,
            const double                    timeout,
            const std::function<bool()>    &stop)
  {
    const OpenFile out(open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666),
                       log.string());
    return run({ command, out, "", false }, timeout, UINTMAX_MAX, stop);
  }

  ChildOutput
  output_of_child(const std::vector<std::string> &command, const ChildLimits &limits)
  {
    const OpenFile out(memfd_create("output", MFD_CLOEXEC), "the output of " + command.at(0));
    const ChildEnd end = run({ command, out, limits.directory.string(), true }, limits.timeout,
                             limits.max_output_bytes, {});
    return { end, out.text_from_begin() };
  }
} // namespace Exemplar
