// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_process_group_h
#define exemplar_process_group_h

#include <functional>
#include <ostream>

namespace Exemplar
{
  /// The processes that run a program together, as seen by one of them.
  struct ProcessGroup
  {
    unsigned int n_processes = 1;
    unsigned int process     = 0; ///< index of this process

    /// Barrier: to be called by all, returns when all have called it.
    std::function<void()> wait_for_all = [] {};

    /// Whether this is the process that prints, and writes files.
    bool
    is_root() const
    {
      return process == 0;
    }

    /// Run `action` on the root alone.
    template <typename Action>
    void
    at_root(const Action &action) const
    {
      if (is_root())
        action();
    }

    /// `out` at the root; elsewhere a stream that discards its output.
    std::ostream &
    of_root(std::ostream &out) const
    {
      static std::ostream nowhere(nullptr);
      return is_root() ? out : nowhere;
    }
  };
} // namespace Exemplar

#endif
