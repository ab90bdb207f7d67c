// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_process_group_h
#define exemplar_process_group_h

#include <functional>

namespace Exemplar
{
  /// Processes that run a program together, seen from one of them.
  struct ProcessGroup
  {
    unsigned int n_processes = 1;
    unsigned int process     = 0; ///< which of them this is

    /// To be called by all: returns when all have called it.
    std::function<void()> wait_for_all = [] {};

    /// Whether this is the process that prints, and writes files.
    bool
    is_root() const
    {
      return process == 0;
    }
  };
} // namespace Exemplar

#endif
