// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/whole_program.h>
#include <exemplar/program/live_program.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <unistd.h>

namespace Exemplar
{
  void
  become_live_program(char *argv[])
  {
    std::error_code             ignored;
    const std::filesystem::path own     = std::filesystem::read_symlink("/proc/self/exe", ignored);
    const std::string           program = (own.parent_path() / "exemplar-live").string();
    execv(program.c_str(), argv);
    throw UserError(program + " cannot be started, which exemplar live needs: "
                    + std::strerror(errno) + ". " + build_whole_program + "; or install it whole.");
  }
} // namespace Exemplar
