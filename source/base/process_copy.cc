// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/process_copy.h>
#include <exemplar/base/time_limit.h>

#include <fmt/core.h>

#include <fcntl.h>
#include <poll.h>
#include <stdio_ext.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <system_error>

namespace Exemplar
{
  namespace
  {
    /// The last byte of a complete answer.
    constexpr char end_mark = '.';

    /// The first byte of an answer, the kind of its contents.
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

    /// Both ends of a pipe.
    struct Pipe
    {
      Pipe()
      {
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0)
          throw std::system_error(errno, std::generic_category(), "opening a pipe");
        in  = ends[0];
        out = ends[1];
      }

      Pipe(const Pipe &) = delete;
      Pipe &
      operator=(const Pipe &)
          = delete;

      ~Pipe()
      {
        close(in);
        close_out();
      }

      void
      close_out()
      {
        if (out >= 0)
          close(out);
        out = -1;
      }

      int in = -1, out = -1;
    };

    /// In the copy: close all files but the pipe to the parent, whose new descriptor is returned,
    /// and redirect the standard output and error to `messages`, or discard them if that is
    /// negative.
    int
    keep_only(const int out, const int messages)
    {
      constexpr int kept = STDERR_FILENO + 1;
      const int     null = open("/dev/null", O_RDWR);
      const int     talk = messages >= 0 ? messages : null;
      __fpurge(stdout); // discard the parent's unwritten output
      if (null < 0 || dup2(null, STDIN_FILENO) < 0 || dup2(talk, STDOUT_FILENO) < 0
          || dup2(talk, STDERR_FILENO) < 0 || (out != kept && dup3(out, kept, O_CLOEXEC) < 0))
        _exit(1);
      close_range(kept + 1, ~0U, 0);
      return kept;
    }

    /// In the copy: end with the parent, without its own handling of signals and without a core
    /// file.
    void
    depend_on(const pid_t parent)
    {
      setpgid(0, 0);
      for (const int signal : { SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGQUIT })
        std::signal(signal, SIG_IGN); // the parent handles them, and this ends with it
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      const rlimit none{ 0, 0 };
      setrlimit(RLIMIT_CORE, &none);
      if (getppid() != parent)
        _exit(1);
      std::atexit([] { _exit(1); }); // a library that calls exit() must not clean up for the parent
    }

    [[noreturn]] void
    work_and_end(const std::function<std::string()> &work, const int out)
    {
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

    /// A copy of the process, killed by the destructor together with all processes that it has
    /// started.
    class Copy
    {
    public:
      Copy(const std::function<std::string()> &work, const bool has_messages)
      {
        const pid_t parent = getpid();
        id                 = fork();
        if (id == 0)
        {
          depend_on(parent);
          work_and_end(work, keep_only(answers.out, has_messages ? messages.out : -1));
        }
        if (id < 0)
          throw std::system_error(errno, std::generic_category(), "starting a process");
        setpgid(id, id); // in parent and copy, whichever comes first
        answers.close_out();
        messages.close_out();
      }

      Copy(const Copy &) = delete;
      Copy &
      operator=(const Copy &)
          = delete;

      ~Copy()
      {
        if (id < 0)
          return;
        kill(-id, SIGKILL);
        while (waitpid(id, nullptr, 0) < 0 && errno == EINTR)
          ;
      }

      /// Read the answer until the copy ends. Throws if it exceeds a limit.
      std::string
      read(const CopyTask &task, CopyMessages *said) const
      {
        std::string     answer;
        const TimeLimit time(task.timeout);
        pollfd          ends[] = { { answers.in, POLLIN, 0 }, { messages.in, POLLIN, 0 } };
        for (;;)
        {
          poll(ends, 2, 200);
          if (task.meanwhile)
            task.meanwhile();
          std::string ignored;
          if (ends[1].revents != 0 && !append(ends[1].fd, said != nullptr ? said->text : ignored))
            ends[1].fd = -1; // no longer polled
          const bool has_ended = ends[0].revents != 0 && !append(ends[0].fd, answer);
          if (has_ended && ends[1].revents == 0) // its children may keep its messages open
            return answer;
          if (said != nullptr && said->text.size() > said->max_bytes)
            throw SolverFailure(
                fmt::format("{} wrote more than {} MiB of messages and was ended. {}", task.what,
                            said->max_bytes >> 20, task.remedy));
          if (const auto exceeded = time.exceeded_by(id))
            throw SolverFailure(fmt::format("{} did not come to an end within {} and was ended. {}",
                                            task.what, *exceeded, task.remedy));
        }
      }

    private:
      /// Append the bytes available in a pipe; false at its end.
      static bool
      append(const int in, std::string &text)
      {
        char          buffer[1 << 16];
        const ssize_t n = ::read(in, buffer, sizeof(buffer));
        if (n > 0)
          text.append(buffer, static_cast<std::size_t>(n));
        return n > 0 || (n < 0 && errno == EINTR);
      }

      Pipe  answers, messages;
      pid_t id = -1;
    };
  } // namespace

  std::string
  in_process_copy(const std::function<std::string()> &work,
                  const CopyTask                     &task,
                  CopyMessages                       *messages)
  {
    const std::string answer = Copy(work, messages != nullptr).read(task, messages);
    if (answer.size() < 2 || answer.back() != end_mark)
      throw SolverFailure(task.what + " crashed in a library that it uses. " + task.remedy);
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
