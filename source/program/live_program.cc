// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/program/live_program.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <unistd.h>

namespace Exemplar
{
  const std::map<std::string, std::string> live_commands
      = { { "live", "pull the body of a scene with the mouse, in a browser" },
          { "export", "write the frames of a finished run as one page of HTML" } };

  void
  become_live_program(char *argv[])
  {
    std::error_code             ignored;
    const std::filesystem::path own     = std::filesystem::read_symlink("/proc/self/exe", ignored);
    const std::string           program = (own.parent_path() / "exemplar-live").string();
    execv(program.c_str(), argv);
    throw UserError(program + " cannot be started, which exemplar " + argv[1]
                    + " needs: " + std::strerror(errno) + ". Install exemplar whole.");
  }
} // namespace Exemplar
