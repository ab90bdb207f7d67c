// SPDX-License-Identifier: GPL-3.0-or-later
// Stubs of commands that ./demo.sh does not build, with their messages.
#include <exemplar/base/errors.h>
#include <exemplar/base/whole_program.h>
#include <exemplar/program/commands.h>
#include <exemplar/study/study.h>
#include <exemplar/verification/verification.h>

namespace Exemplar
{
  namespace
  {
    [[noreturn]] void
    refuse(const std::string &command)
    {
      throw UserError("exemplar " + command + " is not in this build, which runs scenes. "
                      + build_whole_program + ".");
    }
  } // namespace

  void
  run_mesh_command(const MeshCommandOptions &)
  {
    refuse("mesh");
  }

  void
  carry_poses(const PoseOptions &)
  {
    refuse("pose");
  }

  int
  verify(const std::vector<std::string> &, const ProcessGroup &)
  {
    refuse("verify");
  }

  void
  list_verification_cases(const ProcessGroup &)
  {
    refuse("verify");
  }

  void
  run_study(const StudyOptions &)
  {
    refuse("study");
  }

  void
  validate_study(const std::filesystem::path &)
  {
    refuse("study");
  }

  void
  print_study_parameters()
  {
    refuse("study");
  }
} // namespace Exemplar
