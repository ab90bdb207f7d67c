// SPDX-License-Identifier: GPL-3.0-or-later
// Stubs in place of functional.cc and its gradients in the build of ./demo.sh.
#include <exemplar/base/errors.h>
#include <exemplar/base/whole_program.h>
#include <exemplar/run/adjoint/functional.h>
#include <exemplar/run/problem/problem.h>

namespace Exemplar
{
  void
  require_functional(const Problem &problem)
  {
    if (!problem.parameters.output.functional.empty())
      throw UserError("Output/Functional needs gradients, which are not in this build. "
                      + std::string(build_whole_program) + ". Or leave it out.");
  }

  std::optional<FunctionalReport>
  functional_at_end(Problem &)
  {
    return {};
  }
} // namespace Exemplar
