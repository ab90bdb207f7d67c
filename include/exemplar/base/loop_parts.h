// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loop_parts_h
#define exemplar_loop_parts_h

#include <exemplar/base/environment.h>

#include <cstddef>

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
} // namespace Exemplar

#endif
