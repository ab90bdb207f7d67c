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

  /// The threads of this program, those of BLAS aside: as many as cores are available
  /// to the process, or what set_n_threads() says. Results do not depend on it.
  unsigned int
  n_threads();

  /// To be called before any thread starts; at least 1.
  void
  set_n_threads(unsigned int n);

  /// While it lives, OpenMP's parallel regions of this program may have n_threads() threads;
  /// otherwise none has more than one, so that CHOLMOD's have not.
  class ParallelRegion
  {
  public:
    ParallelRegion();
    ~ParallelRegion();

    ParallelRegion(const ParallelRegion &) = delete;
    ParallelRegion &
    operator=(const ParallelRegion &)
        = delete;
  };

  /// BLAS and CHOLMOD on one thread: results must not depend on how many there are,
  /// and CHOLMOD's own threads cost more than they bring.
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
