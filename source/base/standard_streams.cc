// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/standard_streams.h>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <iostream>

namespace Exemplar
{
  void
  secure_standard_streams()
  {
    for (const int descriptor : { STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO })
      if (::fcntl(descriptor, F_GETFD)
          < 0) // opening takes the least free descriptor, which is this one
        if (::open("/dev/null", descriptor == STDIN_FILENO ? O_RDONLY : O_WRONLY) < 0)
          ::open("/",
                 O_RDONLY | O_DIRECTORY); // fallback without /dev; cannot be written to, either
    std::signal(SIGPIPE, SIG_IGN);
  }

  void
  require_printed()
  {
    if (std::cout.flush())
      return;
    pollfd out{ STDOUT_FILENO, POLLOUT, 0 };
    if (::poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0)
      return;
    throw UserError("Standard output cannot be written, and what was printed is not whole. Is the "
                    "disk full? Print "
                    "to another place.");
  }
} // namespace Exemplar
