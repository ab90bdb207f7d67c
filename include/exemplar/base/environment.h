// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_environment_h
#define exemplar_environment_h

#include <string>

namespace Exemplar
{
  /// The BLAS in use, as far as it is known.
  struct BlasInfo
  {
    std::string library; ///< "OpenBLAS 0.3.21", or "unknown" (the reference BLAS, say)
    std::string core;    ///< OpenBLAS's core type; empty for others
    std::string file;    ///< the library's file
    int         threads; ///< number of threads, as far as known
  };

  BlasInfo
  blas_info();

  /// Advice if the BLAS is not OpenBLAS; empty if it is.
  std::string
  blas_warning();

  /// A sentence if this CPU has instruction sets for which the loops of this build were not
  /// compiled; otherwise empty.
  std::string
  instruction_set_warning();

  /// During its lifetime, parallel regions of OpenMP that libraries such as CHOLMOD begin in this
  /// thread have one thread: more cost more than they bring, and spin where others need the cores.
  class OneOpenMPThread
  {
  public:
    OneOpenMPThread();
    ~OneOpenMPThread();

    OneOpenMPThread(const OneOpenMPThread &) = delete;
    OneOpenMPThread &
    operator=(const OneOpenMPThread &)
        = delete;

  private:
    const int levels_before;
  };

  /// Set the number of threads of OpenBLAS in the whole process; returns the number before, or 1 and does nothing if BLAS is another
  /// library.
  int
  set_blas_threads(int n);

  /// Restrict OpenBLAS to one thread in the whole process, and the parallel regions that libraries
  /// begin in this thread, so that results do not depend on the number of threads.
  void
  use_one_blas_thread();

  /// Restart this program with OPENBLAS_CORETYPE set if OpenBLAS takes an unknown CPU for an old
  /// one, which makes it several times slower; does not return if it does. To be called first in
  /// main().
  void
  restart_with_right_core_type(char *argv[]);

  /// Greatest resident memory of this process [MiB].
  double
  peak_memory_mib();
} // namespace Exemplar

#endif
