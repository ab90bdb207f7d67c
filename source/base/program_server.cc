// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/program_server.h>
#include <exemplar/base/time_limit.h>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <system_error>

// Protocol: a request is its size in bytes and texts that end with NUL: the log and the arguments.
// The answers are the process id of the run, then its end. The process is waited for only after the
// client has confirmed the latter, so that its id is not reused before.

namespace Exemplar
{
  namespace
  {
    /// Transfer all bytes; returns whether that succeeded.
    template <typename Transfer, typename Byte>
    bool
    transfer_all(const Transfer &transfer, const int socket, Byte *bytes, std::size_t n)
    {
      while (n > 0)
      {
        const ssize_t done = transfer(socket, bytes, n);
        if (done < 0 && errno == EINTR)
          continue;
        if (done <= 0)
          return false;
        bytes += done;
        n -= static_cast<std::size_t>(done);
      }
      return true;
    }

    template <typename Value>
    bool
    take(const int socket, Value &value)
    {
      return transfer_all([](int from, char *bytes, std::size_t n) { return read(from, bytes, n); },
                          socket, reinterpret_cast<char *>(&value), sizeof value);
    }

    bool
    send_bytes(const int socket, const char *bytes, const std::size_t n)
    {
      return transfer_all([](int to, const char *from, std::size_t size)
                          { return send(to, from, size, MSG_NOSIGNAL); },
                          socket, bytes, n);
    }

    template <typename Value>
    bool
    give(const int socket, const Value &value)
    {
      return send_bytes(socket, reinterpret_cast<const char *>(&value), sizeof value);
    }

    /// Ignores signals that end programs, which a terminal sends to all of its processes; the
    /// server leaves the reaction to the others, and ends with them.
    class IgnoredSignals
    {
    public:
      IgnoredSignals()
      {
        struct sigaction ignore
        {
        };
        ignore.sa_handler = SIG_IGN;
        for (std::size_t i = 0; i < signals.size(); ++i)
          sigaction(signals[i], &ignore, &before[i]);
      }

      void
      restore() const
      {
        for (std::size_t i = 0; i < signals.size(); ++i)
          sigaction(signals[i], &before[i], nullptr);
      }

    private:
      static constexpr std::array<int, 4> signals = { { SIGINT, SIGTERM, SIGHUP, SIGQUIT } };
      std::array<struct sigaction, 4>     before;
    };

    void
    end_with_parent(const pid_t parent)
    {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (getppid() != parent) // the parent has died before the line above
        _exit(no_such_program);
    }

    /// Run the program, in the copy made for it.
    [[noreturn]] void
    run_main(const ProgramServer::Main &main, std::vector<char> &texts)
    {
      std::vector<char *> argv;
      for (std::size_t i = 0; i < texts.size(); i += std::strlen(&texts[i]) + 1)
        argv.push_back(&texts[i]);
      const int in  = open("/dev/null", O_RDONLY);
      const int out = open(argv[0], O_WRONLY | O_TRUNC);
      if (in < 0 || out < 0 || dup2(in, STDIN_FILENO) < 0 || dup2(out, STDOUT_FILENO) < 0
          || dup2(out, STDERR_FILENO) < 0)
        _exit(no_such_program);
      close(in);
      close(out);
      argv.push_back(nullptr);
      std::exit(main(static_cast<int>(argv.size()) - 2, argv.data() + 1));
    }

    [[noreturn]] void
    serve(const ProgramServer::Main &main, const int socket)
    {
      const IgnoredSignals signals;
      std::size_t          size = 0;
      while (take(socket, size))
      {
        std::vector<char> texts(size);
        const auto        receive
            = [](int from, char *bytes, std::size_t n) { return read(from, bytes, n); };
        if (!transfer_all(receive, socket, texts.data(), size))
          break;
        const pid_t parent = getpid(), child = fork();
        if (child == 0)
        {
          end_with_parent(parent);
          close(socket);
          signals.restore();
          run_main(main, texts);
        }
        siginfo_t end{};
        char      confirmation;
        if (!give(socket, child) || child < 0)
          break;
        while (waitid(P_PID, static_cast<id_t>(child), &end, WEXITED | WNOWAIT) != 0
               && errno == EINTR)
          continue;
        const int status = end.si_code == CLD_EXITED ? W_EXITCODE(end.si_status, 0) : end.si_status;
        if (!give(socket, status) || !take(socket, confirmation))
          break;
        waitpid(child, nullptr, 0);
      }
      _exit(0);
    }

    /// Set ChildEnd from the status of waitpid().
    void
    tell(const int status, ChildEnd &end)
    {
      end.signal      = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
      end.exit_status = end.signal != 0 ? 128 + end.signal : WEXITSTATUS(status);
    }
  } // namespace

  ProgramServer::ProgramServer(const Main &main)
  {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
      throw std::system_error(errno, std::generic_category(), "opening a socket");
    connection         = std::make_unique<Descriptor>(ends[0]);
    const pid_t parent = getpid();
    server             = fork();
    if (server == 0)
    {
      end_with_parent(parent);
      close(ends[0]);
      serve(main, ends[1]);
    }
    close(ends[1]);
    if (server < 0)
      throw std::system_error(errno, std::generic_category(), "starting a process");
  }

  ProgramServer::~ProgramServer()
  {
    end_server();
  }

  int
  ProgramServer::end_server()
  {
    connection.reset();
    int status = 0;
    if (server > 0)
      waitpid(server, &status, 0);
    server = 0;
    return status;
  }

  ChildEnd
  ProgramServer::run(const std::vector<std::string> &arguments,
                     const std::filesystem::path    &log,
                     const double                    timeout,
                     const std::function<bool()>    &stop)
  {
    if (connection == nullptr)
      return run_child(arguments, log, timeout, stop);
    if (const Descriptor out(open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
        out.number < 0)
      throw std::system_error(errno, std::generic_category(), log.string());
    const int       socket = connection->number;
    const TimeLimit time(timeout);
    std::string     texts = log.string() + '\0';
    for (const std::string &argument : arguments)
      texts += argument + '\0';
    pid_t      run      = -1;
    const bool has_come = give(socket, texts.size())
                          && send_bytes(socket, texts.data(), texts.size()) && take(socket, run)
                          && run > 0;
    ChildEnd end;
    bool     is_interrupted = false;
    for (pollfd answer = { socket, POLLIN, 0 }; has_come && poll(&answer, 1, 5) <= 0;)
    {
      is_interrupted = is_interrupted || (stop && stop());
      if (timeout > 0. && end.exceeded.empty())
        end.exceeded = time.exceeded_by(run).value_or("");
      if (is_interrupted || !end.exceeded.empty())
        kill(run, SIGKILL);
    }
    int status = 0;
    if (!take(socket, status) || !give(socket, '.'))
      status = end_server(); // a killed server counts as a killed run
    end.seconds = time.seconds();
    if (is_interrupted)
      throw Interrupted("Interrupted.");
    tell(status, end);
    return end;
  }
} // namespace Exemplar
