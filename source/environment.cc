// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/environment.h>

#include <cstdlib>
#include <dlfcn.h>
#include <omp.h>
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
    BlasInfo info{ "unknown", "" };
    if (const auto config = find_function<char *()>("openblas_get_config"))
    {
      std::istringstream words(config());
      std::string        name, version;
      words >> name >> version;
      info.library = name + " " + version;
    }
    if (const auto core = find_function<char *()>("openblas_get_corename"))
      info.core = core();
    return info;
  }

  void
  use_one_blas_thread()
  {
    if (const auto set_threads = find_function<void(int)>("openblas_set_num_threads"))
      set_threads(1);
    omp_set_max_active_levels(0);
  }

  void
  restart_with_right_core_type(char *argv[])
  {
    const char *variable = "OPENBLAS_CORETYPE";
    const char *core     = right_core_type();
    if (std::getenv(variable) != nullptr || core == nullptr || !is_old_core(blas_info().core))
      return;
    setenv(variable, core, 1);
    execv("/proc/self/exe", argv); // if it fails we go on, only slower
  }

  double
  peak_memory_mib()
  {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024.;
  }
} // namespace Exemplar
