// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loop_parts_h
#define exemplar_loop_parts_h

#include <exemplar/base/environment.h>

#include <cstddef>
#include <exception>
#include <omp.h>

namespace Exemplar
{
  /// Call function(part, begin, end) for n_parts consecutive parts of the numbers 0 to n - 1, each part in
  /// one of n_threads threads. It must not throw.
  template <typename Function>
  void
  for_each_part(const std::size_t n_parts,
                const std::size_t n,
                const int         n_threads,
                const Function   &function)
  {
    const auto do_part = [&](const std::size_t part)
    { function(part, part * n / n_parts, (part + 1) * n / n_parts); };
    if (n_threads == 1 || n_parts == 1)
    {
      for (std::size_t part = 0; part < n_parts; ++part)
        do_part(part);
      return;
    }
    const OpenMPScope scope(OpenMPScope::Threads::several);
#pragma omp parallel for num_threads(n_threads) schedule(static)
    for (std::size_t part = 0; part < n_parts; ++part)
      do_part(part);
  }

  /// Call function(i, thread) for the tasks 0 to n - 1, of which some may take much longer than others, in
  /// n_threads threads. What the last one to throw has thrown is thrown here.
  template <typename Function>
  void
  for_each_task(const int n, const int n_threads, const Function &function)
  {
    if (n_threads == 1 || n <= 1)
    {
      for (int i = 0; i < n; ++i)
        function(i, 0);
      return;
    }
    std::exception_ptr failure;
    const OpenMPScope  scope(OpenMPScope::Threads::several);
#pragma omp parallel for num_threads(n_threads) schedule(dynamic)
    for (int i = 0; i < n; ++i)
      try
      {
        function(i, omp_get_thread_num());
      }
      catch (...)
      {
#pragma omp critical
        failure = std::current_exception();
      }
    if (failure)
      std::rethrow_exception(failure);
  }
} // namespace Exemplar

#endif
