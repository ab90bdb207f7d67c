// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_process_copy_h
#define exemplar_process_copy_h

#include <functional>
#include <string>

namespace Exemplar
{
  /// Purpose and limits of a copy of this process.
  struct CopyTask
  {
    std::string what;    ///< name in messages about a crash or a limit
    std::string remedy;  ///< a sentence
    double      timeout; ///< [s], of a TimeLimit
    /// Called in this process several times a second meanwhile, if not empty.
    std::function<void()> meanwhile = {};
  };

  /// Output of libraries on the standard streams.
  struct CopyMessages
  {
    std::size_t max_bytes; ///< a copy with more output is killed
    std::string text = {};
  };

  /// Calls `work` in a copy of this process (fork) and returns its result: for libraries that may
  /// crash or never end on odd input, or that keep global state. The copy has no other thread and
  /// none of the open files; it ends with this process, and so do processes that it has started.
  /// Its output goes to `messages`, or is lost if that is null. Exceptions of `work` (UserError,
  /// SolverFailure, std::bad_alloc, any other std::exception) are rethrown here. If the copy
  /// crashes, or exceeds a limit, this throws SolverFailure: "`what` crashed ...", "`what` did not
  /// come to an end within ... s of processor time" and so on, and `remedy`.
  std::string
  in_process_copy(const std::function<std::string()> &work,
                  const CopyTask                     &task,
                  CopyMessages                       *messages = nullptr);
} // namespace Exemplar

#endif
