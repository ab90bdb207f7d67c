// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_trilinos_lock_h
#define exemplar_trilinos_lock_h

#include <mutex>

namespace Exemplar
{
  /// A lock during whose lifetime no other thread calls Trilinos: ML keeps lists of its memory, a
  /// random number generator and timers for the whole process, and MPI takes calls of one thread at
  /// a time. To be held for a call or a few, and never while a function of the host program runs.
  class TrilinosLock
  {
  public:
    TrilinosLock() : lock(mutex) {}

  private:
    inline static std::mutex          mutex;
    const std::lock_guard<std::mutex> lock;
  };
} // namespace Exemplar

#endif
