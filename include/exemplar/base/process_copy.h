// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_process_copy_h
#define exemplar_process_copy_h

#include <functional>
#include <string>

namespace Exemplar
{
  /// Calls `work` in a copy of this process (fork) and returns what it returns: for libraries that
  /// may crash or never end on odd input, or that keep one state for the whole process. The copy
  /// has no standard streams and no other thread, and ends with this process. What `work` throws
  /// (UserError, SolverFailure, std::bad_alloc, any other std::exception) is thrown here. If the
  /// copy crashes, or does not end within `timeout` seconds, this throws SolverFailure:
  /// "`what` crashed" or "`what` did not come to an end within ... s", and `remedy`.
  std::string
  in_process_copy(const std::function<std::string()> &work,
                  double                              timeout,
                  const std::string                  &what,
                  const std::string                  &remedy);
} // namespace Exemplar

#endif
