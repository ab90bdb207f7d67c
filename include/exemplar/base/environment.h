// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_environment_h
#define exemplar_environment_h

#include <string>

namespace Exemplar
{
  /// The BLAS in use, as far as it tells.
  struct BlasInfo
  {
    std::string library; ///< "OpenBLAS 0.3.21", or "unknown" (the reference BLAS, say)
    std::string core;    ///< OpenBLAS's core type; empty for others
    std::string file;    ///< the library's file
    int         threads; ///< as far as it tells
  };

  BlasInfo
  blas_info();

  /// What to do if this is not OpenBLAS; empty if it is.
  std::string
  blas_warning();

  /// A sentence if this CPU has instructions for which the loops of this build were not compiled, or nothing.
  std::string
  instruction_set_warning();

  /// While it lives, parallel regions of OpenMP that libraries such as CHOLMOD begin in this thread
  /// have one thread: more cost more than they bring, and spin where others need the cores.
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

  /// OpenBLAS on one thread in the whole process, and the parallel regions that libraries begin in
  /// this thread: results must not depend on how many there are.
  void
  use_one_blas_thread();

  /// OpenBLAS takes a CPU that it does not know for an old one and is then several
  /// times slower. In that case start this program anew with OPENBLAS_CORETYPE set;
  /// does not return if it does. To be called first in main().
  void
  restart_with_right_core_type(char *argv[]);

  /// Greatest resident memory of this process [MiB].
  double
  peak_memory_mib();
} // namespace Exemplar

#endif
