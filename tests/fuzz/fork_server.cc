// SPDX-License-Identifier: GPL-3.0-or-later
// Nine tenths of a short run go into linking deal.II's two hundred libraries. Preloaded into the
// program, this library stops it before main(), when all are linked, and forks a run for each
// request that comes through the socket whose number is in FORK_SERVER_SOCKET. fork_server.py is
// the other end. A request is a Request with the descriptors of standard output and standard error,
// then the strings, each ended by NUL: working directory and arguments, then the environment. The
// answers, 64-bit numbers, are the run's process and, when it has ended, its status. A run that is
// to stand still has stopped itself before main(), and main() waits for SIGCONT: so long strace can
// be attached to it.

#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

namespace
{
  /// Numbers of bytes: of the strings, and the run's limits; no address space: no limit. Then
  /// whether the run is to stand still.
  struct Request
  {
    std::uint64_t arguments, environment, address_space, file_size, stands_still;
  };

  void
  end_unless(const bool fine)
  {
    if (!fine)
      _exit(0); // the other end has gone
  }

  /// Receives the next request and its two descriptors.
  Request
  receive(const int socket, int (&streams)[2])
  {
    Request               request;
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(streams))];
    iovec                 bytes{ &request, sizeof(request) };
    msghdr                message{};
    message.msg_iov        = &bytes;
    message.msg_iovlen     = 1;
    message.msg_control    = control;
    message.msg_controllen = sizeof(control);
    end_unless(recvmsg(socket, &message, MSG_WAITALL) == sizeof(request));
    const cmsghdr *header = CMSG_FIRSTHDR(&message);
    end_unless(header != nullptr);
    __builtin_memcpy(streams, CMSG_DATA(header), sizeof(streams));
    return request;
  }

  /// Strings that came through the socket.
  struct Strings
  {
    Strings(const int socket, const std::uint64_t size)
        : text(static_cast<char *>(std::malloc(size + 1)))
    {
      for (std::uint64_t n = 0; n < size;)
      {
        const ssize_t got = read(socket, text + n, size - n);
        end_unless(got > 0);
        n += static_cast<std::uint64_t>(got);
      }
      for (char *at = text; at < text + size && n < maximum; at += __builtin_strlen(at) + 1)
        pointers[n++] = at;
      pointers[n] = nullptr;
    }

    Strings(const Strings &) = delete;

    ~Strings()
    {
      std::free(text);
    }

    static constexpr std::size_t maximum = 1000;

    char       *text;
    char       *pointers[maximum + 1];
    std::size_t n = 0;
  };

  void
  limit(const int resource, const std::uint64_t maximum)
  {
    const rlimit limits{ maximum, maximum };
    setrlimit(static_cast<__rlimit_resource>(resource), &limits);
  }

  void
  answer(const int socket, const std::int64_t number)
  {
    end_unless(write(socket, &number, sizeof(number)) == sizeof(number));
  }

  /// Makes this process the run that was asked for, up to its main().
  void
  become_run(const Request &request,
             const Strings &words,
             Strings       &environment,
             const int (&streams)[2],
             char            **argv,
             const std::size_t room)
  {
    dup2(streams[0], STDOUT_FILENO);
    dup2(streams[1], STDERR_FILENO);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, request.file_size);
    if (request.address_space > 0)
      limit(RLIMIT_AS, request.address_space);
    if (words.n == 0 || words.n > room || chdir(words.pointers[0]) != 0)
      _exit(125); // as env does what cannot be run
    for (std::size_t i = 1; i < words.n; ++i)
      argv[i] = words.pointers[i];
    argv[words.n] = nullptr;
    // _start reads the number of arguments before them
    reinterpret_cast<std::int64_t *>(argv)[-1] = static_cast<std::int64_t>(words.n);
    environ                                    = environment.pointers;
    if (request.stands_still != 0)
    {
      prctl(PR_SET_PTRACER, PR_SET_PTRACER_ANY); // strace need not be a parent
      raise(SIGSTOP);
    }
  }

  __attribute__((constructor)) void
  serve(const int argc, char **argv, char **)
  {
    const char *descriptor = std::getenv("FORK_SERVER_SOCKET");
    if (descriptor == nullptr)
      return;
    const int socket = std::atoi(descriptor);
    for (;;)
    {
      int           streams[2];
      const Request request = receive(socket, streams);
      // these live as long as the process that uses them
      auto       *words       = new Strings(socket, request.arguments);
      auto       *environment = new Strings(socket, request.environment);
      const pid_t child       = fork();
      if (child == 0)
        become_run(request, *words, *environment, streams, argv, static_cast<std::size_t>(argc));
      for (const int stream : streams)
        close(stream);
      if (child == 0)
      {
        close(socket);
        return;
      }
      int status = 0;
      if (request.stands_still != 0)
        waitpid(child, &status, WUNTRACED);
      answer(socket, child);
      if (request.stands_still == 0 || WIFSTOPPED(status))
        waitpid(child, &status, 0);
      answer(socket, WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status));
      delete words;
      delete environment;
    }
  }
} // namespace
