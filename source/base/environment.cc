// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/built_instruction_sets.h>
#include <exemplar/base/environment.h>

#include <csignal>
#include <cstdlib>
#include <dlfcn.h>
#include <sstream>
#include <sys/resource.h>
#include <unistd.h>

namespace Exemplar
{
  namespace
  {
    /// A function of the BLAS library, if it has one of this name.
    template <typename Function>
    Function *
    find_function(const char *name)
    {
      return reinterpret_cast<Function *>(dlsym(RTLD_DEFAULT, name));
    }

    /// Set what a library counts, if it is loaded and has functions of these names; returns the number before, or that it has without.
    int
    exchange(const char *getter, const char *setter, const int n, const int without)
    {
      const auto get = find_function<int()>(getter);
      const auto set = find_function<void(int)>(setter);
      if (get == nullptr || set == nullptr)
        return without;
      const int before = get();
      set(n);
      return before;
    }

    /// Set the number of levels of OpenMP's parallel regions that may have several threads, in this thread; returns the number before.
    int
    set_openmp_levels(const int n)
    {
      return exchange("omp_get_max_active_levels", "omp_set_max_active_levels", n, 0);
    }

    /// The best core type of OpenBLAS for this CPU, by its instruction sets.
    const char *
    right_core_type()
    {
#ifdef __x86_64__
      if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")
          && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
        return "SKYLAKEX";
      if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        return "HASWELL";
#endif
      return nullptr;
    }

    bool
    is_old_core(const std::string &core)
    {
      for (const char *old : { "Prescott", "Core2", "Katmai", "Coppermine", "Northwood", "Banias",
                               "Penryn", "Dunnington", "Nehalem", "Atom", "Opteron", "Barcelona" })
        if (core == old)
          return true;
      return false;
    }
  } // namespace

  BlasInfo
  blas_info()
  {
    BlasInfo info{ "unknown", "", "an unknown library", 1 };
    if (const auto config = find_function<char *()>("openblas_get_config"))
    {
      std::istringstream words(config());
      std::string        name, version;
      words >> name >> version;
      info.library = name + " " + version;
    }
    if (const auto core = find_function<char *()>("openblas_get_corename"))
      info.core = core();
    if (const auto threads = find_function<int()>("openblas_get_num_threads"))
      info.threads = threads();
    Dl_info where;
    if (dladdr(dlsym(RTLD_DEFAULT, "dgemm_"), &where) != 0)
      info.file = where.dli_fname;
    return info;
  }

  std::string
  blas_warning()
  {
    const BlasInfo info = blas_info();
    if (info.library != "unknown")
      return "";
    return "BLAS is not OpenBLAS but " + info.file
           + ". If that is the reference BLAS, factorisations by CHOLMOD and UMFPACK take four to "
             "five "
             "times as long as they need. Install OpenBLAS; on Debian: apt-get install "
             "libopenblas0-pthread, or if "
             "it is there choose it by update-alternatives.";
  }

  std::string
  instruction_set_warning()
  {
    if (built_instruction_set() == best_instruction_set())
      return "";
    return "This program was built for another kind of CPU. Its loops over cells leave out "
           "instructions that this one has, and take up to four times as long as they need. Build "
           "it here, or for all by cmake -DEXEMPLAR_INSTRUCTION_SETS=all.";
  }

  OneOpenMPThread::OneOpenMPThread() : levels_before(set_openmp_levels(0)) {}

  OneOpenMPThread::~OneOpenMPThread()
  {
    set_openmp_levels(levels_before);
  }

  int
  set_blas_threads(const int n)
  {
    return exchange("openblas_get_num_threads", "openblas_set_num_threads", n, 1);
  }

  void
  use_one_blas_thread()
  {
    set_blas_threads(1);
    set_openmp_levels(0);
  }

  void
  restart_with_right_core_type(char *argv[])
  {
    const char *variable = "OPENBLAS_CORETYPE";
    const char *core     = right_core_type();
    if (std::getenv(variable) != nullptr || core == nullptr || !is_old_core(blas_info().core))
      return;
    setenv(variable, core, 1);
    // block interrupts until the restarted program has installed its handlers
    sigset_t interrupts, before;
    sigemptyset(&interrupts);
    for (const int signal : { SIGINT, SIGTERM, SIGXCPU, SIGHUP })
      sigaddset(&interrupts, signal);
    pthread_sigmask(SIG_BLOCK, &interrupts, &before);
    execv("/proc/self/exe", argv);
    pthread_sigmask(SIG_SETMASK, &before, nullptr); // the restart has failed: go on, only slower
  }

  double
  peak_memory_mib()
  {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024.;
  }
} // namespace Exemplar
