// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_unlocked_work_h
#define exemplar_unlocked_work_h

#include <exemplar/base/environment.h>

#include <pybind11/pybind11.h>

#include <optional>

namespace Exemplar::Python
{
  /// Releases Python's lock while it lives, so that other threads of Python run. At its end Python
  /// kills threads that want the lock, for which C++ ends the process: end_all(), called first
  /// then, waits for all such work. BLAS has one thread meanwhile: results follow their number in
  /// the last digits, and small matrices take ten times as long where other work keeps cores busy.
  class UnlockedWork
  {
  public:
    UnlockedWork();
    ~UnlockedWork();

    UnlockedWork(const UnlockedWork &) = delete;
    UnlockedWork &
    operator=(const UnlockedWork &)
        = delete;

    /// Throws SystemExit, which ends a thread silently, if Python ends. To be called with Python's
    /// lock before such work and now and then within.
    static void
    check();

    static void
    end_all();

  private:
    // these are read and written with Python's lock alone
    inline static unsigned int n_running           = 0;
    inline static int          blas_threads_before = 1;
    inline static bool         is_ending           = false;

    OneOpenMPThread one_thread;

    std::optional<pybind11::gil_scoped_release> unlocked;
  };
} // namespace Exemplar::Python

#endif
