// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_process_copy_h
#define exemplar_process_copy_h

#include <functional>
#include <string>

namespace Exemplar
{
  /// What a copy of this process is for, and what it is allowed.
  struct CopyTask
  {
    std::string what;    ///< is said to have crashed, or to have come to no end
    std::string remedy;  ///< a sentence
    double      timeout; ///< [s], of a TimeLimit
    /// Called here several times a second while it works, if it is not empty.
    std::function<void()> meanwhile = {};
  };

  /// What libraries say on the standard streams.
  struct CopyMessages
  {
    std::size_t max_bytes; ///< a copy that says more is ended
    std::string text = {};
  };

  /// Calls `work` in a copy of this process (fork) and returns what it returns: for libraries that
  /// may crash or never end on odd input, or that keep one state for the whole process. The copy
  /// has no other thread and none of the files that are open here; it ends with this process, and
  /// so does what it has started. `messages` takes what is said there; without it nobody hears it.
  /// What `work` throws (UserError, SolverFailure, std::bad_alloc, any other std::exception) is
  /// thrown here. If the copy crashes, or goes beyond a limit, this throws SolverFailure:
  /// "`what` crashed ...", "`what` did not come to an end within ... s of processor time" and so on, and `remedy`.
  std::string
  in_process_copy(const std::function<std::string()> &work,
                  const CopyTask                     &task,
                  CopyMessages                       *messages = nullptr);
} // namespace Exemplar

#endif
