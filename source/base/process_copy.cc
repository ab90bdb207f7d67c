// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/process_copy.h>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <new>
#include <system_error>

namespace Exemplar
{
  namespace
  {
    /// The last byte of an answer that is whole.
    constexpr char end_mark = '.';

    /// The first byte of an answer: what follows it.
    enum Answer : char
    {
      value          = 'v',
      user_error     = 'u',
      solver_failure = 's',
      no_memory      = 'm',
      other_error    = 'e'
    };

    std::string
    answer_of(const std::function<std::string()> &work)
    {
      const auto tagged
          = [](const Answer tag, const std::string &text) { return char(tag) + text; };
      try
      {
        return tagged(value, work());
      }
      catch (const UserError &error)
      {
        return tagged(user_error, error.what());
      }
      catch (const SolverFailure &error)
      {
        return tagged(solver_failure, error.what());
      }
      catch (const std::bad_alloc &)
      {
        return tagged(no_memory, "");
      }
      catch (const std::exception &error)
      {
        return tagged(other_error, error.what());
      }
    }

    /// In the copy.
    [[noreturn]] void
    work_and_end(const std::function<std::string()> &work, const int out, const pid_t parent)
    {
      for (const int signal : { SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGQUIT })
        std::signal(signal, SIG_IGN); // the parent takes them, and this ends with it
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      const rlimit none{ 0, 0 };
      setrlimit(RLIMIT_CORE, &none);
      const int null = open("/dev/null", O_RDWR);
      if (getppid() != parent || null < 0)
        _exit(1);
      for (const int stream : { STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO })
        dup2(null, stream); // libraries may talk
      const std::string answer = answer_of(work) + end_mark;
      for (std::size_t n = 0; n < answer.size();)
      {
        const ssize_t written = write(out, answer.data() + n, answer.size() - n);
        if (written < 0 && errno != EINTR)
          _exit(1);
        n += written > 0 ? static_cast<std::size_t>(written) : 0;
      }
      _exit(0);
    }

    /// A copy of the process, killed if nobody has waited for its end.
    class Copy
    {
    public:
      explicit Copy(const std::function<std::string()> &work)
      {
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0)
          throw std::system_error(errno, std::generic_category(), "opening a pipe");
        in                 = ends[0];
        const pid_t parent = getpid();
        id                 = fork();
        if (id == 0)
          work_and_end(work, ends[1], parent);
        const int error = errno;
        close(ends[1]);
        if (id < 0)
        {
          close(in);
          throw std::system_error(error, std::generic_category(), "starting a process");
        }
      }

      Copy(const Copy &) = delete;
      Copy &
      operator=(const Copy &)
          = delete;

      ~Copy()
      {
        close(in);
        if (id > 0)
          end();
      }

      /// All that it says until it ends; false if it takes longer.
      bool
      read(const double timeout, std::string &answer) const
      {
        using Clock      = std::chrono::steady_clock;
        const auto begin = Clock::now();
        char       buffer[1 << 16];
        for (;;)
        {
          pollfd end{ in, POLLIN, 0 };
          if (poll(&end, 1, 200) > 0)
          {
            const ssize_t n = ::read(in, buffer, sizeof(buffer));
            if (n == 0)
              return true;
            if (n > 0)
              answer.append(buffer, static_cast<std::size_t>(n));
          }
          if (std::chrono::duration<double>(Clock::now() - begin).count() > timeout)
            return false;
        }
      }

    private:
      /// It has said all, or is ended.
      void
      end() const
      {
        kill(id, SIGKILL);
        while (waitpid(id, nullptr, 0) < 0 && errno == EINTR)
          ;
      }

      int   in = -1;
      pid_t id = -1;
    };
  } // namespace

  std::string
  in_process_copy(const std::function<std::string()> &work,
                  const double                        timeout,
                  const std::string                  &what,
                  const std::string                  &remedy)
  {
    std::string answer;
    const bool  has_ended = Copy(work).read(timeout, answer);
    if (!has_ended)
      throw SolverFailure(what + " did not come to an end within "
                          + std::to_string(static_cast<long>(timeout)) + " s and was ended. "
                          + remedy);
    if (answer.size() < 2 || answer.back() != end_mark)
      throw SolverFailure(what + " crashed in a library that it uses. " + remedy);
    const std::string text = answer.substr(1, answer.size() - 2);
    switch (answer[0])
    {
    case user_error:
      throw UserError(text);
    case solver_failure:
      throw SolverFailure(text);
    case no_memory:
      throw std::bad_alloc();
    case other_error:
      throw std::runtime_error(text);
    default:
      return text;
    }
  }
} // namespace Exemplar
